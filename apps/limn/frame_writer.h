// What happens to a frame once it is drawn: hash, encode, write, note for the manifest.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "apps/limn/job.h"
#include "apps/limn/manifest.h"
#include "apps/limn/options.h"
#include "apps/limn/pattern.h"
#include "apps/limn/pipeline.h"

namespace limn::program {

enum class FrameFile {
  kMissing,   ///< not there, damaged or cut
  kOtherJob,  ///< whole, but not what `job` says
  kWhole
};

/// Looks at a PNG file of limn without decoding it. `job` is the text that the file must hold; `hash` becomes the one of
/// its pixels, as the file says.
FrameFile inspectFrame(const std::string& path, const std::string& job, std::string& hash);

struct WriterTimes {
  double hashMs = 0, encodeMs = 0, writeMs = 0;
  std::size_t bytes = 0;
};

class FrameWriter {
 public:
  /// Borrows its arguments. `pattern` null: nothing is written. `frames`: how many this run deals with; `triangles`: of
  /// the coarse scene.
  FrameWriter(const Job& job, const RenderOptions& options, const OutputPattern* pattern, int frames,
              std::size_t triangles);

  /// Whether the files of a frame are there, whole and of the same job; their hashes.
  bool isThere(Picture& picture) const;

  /// From any number of threads at a time. Throws OutputError.
  void finish(Picture& picture);

  const WriterTimes& times() const { return times_; }
  /// By position in the list of this run; empty unless a manifest is wanted and files are written.
  const std::vector<ManifestFrame>& records() const { return records_; }

 private:
  std::string aovJob(int frame, Aov aov) const { return job_.text(frame) + " --aov " + aovName(aov); }
  void finishOrThrow(Picture& picture);
  void writePicture(const Picture& picture, WriterTimes& times);
  void writeAov(Picture& picture, Aov aov, WriterTimes& times);

  const Job& job_;
  const RenderOptions& options_;
  const OutputPattern* pattern_;
  const std::size_t triangles_;
  InOrder standardOutput_;
  std::mutex mutex_;
  WriterTimes times_;
  std::vector<ManifestFrame> records_;
};

}  // namespace limn::program
