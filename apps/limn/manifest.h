// What a run has drawn: the job, and the pixel hash of every frame.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace limn::program {

struct ManifestFrame {
  int frame = 1;
  std::string file;               ///< relative to the manifest's folder
  std::string pixels;             ///< XXH3-128 of the RGBA8 rows
  std::vector<std::string> aovs;  ///< of the 16-bit samples, in the order of Manifest::aovs
};

struct Manifest {
  std::string job;   ///< Job::text()
  std::string list;  ///< frames of the whole run, all shards, as --frames names them
  std::pair<int, int> shard{1, 1};
  bool rgba = false;
  int width = 0, height = 0;
  std::vector<std::string> aovs;
  std::vector<ManifestFrame> frames;

  std::string json() const;
  /// Throws InputError naming the file and the place in it.
  static Manifest read(const std::string& path);
};

/// Hash of the lines that --hash prints for these frames in ascending order: the same however the run was cut up.
std::string jobHash(std::vector<ManifestFrame> frames);

/// `path` as the manifest at `manifest` names it.
std::string relativeTo(const std::string& manifest, const std::string& path);

/// The other way round.
std::string besideManifest(const std::string& manifest, const std::string& file);

}  // namespace limn::program
