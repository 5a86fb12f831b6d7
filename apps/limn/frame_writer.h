// What happens to a frame once it is drawn: hash, encode, write, note for the manifest.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "apps/limn/job.h"
#include "apps/limn/options.h"
#include "apps/limn/pattern.h"
#include "apps/limn/pipeline.h"

namespace limn::program {

struct WriterTimes {
  double hashMs = 0, encodeMs = 0, writeMs = 0;
  std::size_t bytes = 0;
};

class FrameWriter {
 public:
  /// Borrows its arguments. `frames` is how many this run deals with.
  FrameWriter(const Job& job, const RenderOptions& options, const OutputPattern* pattern, int frames);

  /// Whether the files of a frame are there, whole and of the same job; the pixel hash that they hold.
  bool isThere(int frame, std::string& hash) const;

  /// From any number of threads at a time. Throws OutputError.
  void finish(Picture& picture);

  const WriterTimes& times() const { return times_; }
  /// By position in the list of this run; empty unless a manifest is wanted.
  const std::vector<std::string>& hashes() const { return hashes_; }

 private:
  scene::TextChunks texts(int frame, const std::string& hash) const;
  void write(const Picture& picture, const std::string& hash, WriterTimes& times);

  const Job& job_;
  const RenderOptions& options_;
  const OutputPattern* pattern_;  ///< null: nothing is written
  InOrder standardOutput_;
  std::mutex mutex_;
  WriterTimes times_;
  std::vector<std::string> hashes_;
};

}  // namespace limn::program
