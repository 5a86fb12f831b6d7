#include "apps/limn/frame_writer.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>

namespace limn::program {
namespace {

constexpr const char* kJobKeyword = "limn";
constexpr const char* kPixelsKeyword = "limn-pixels";

/// Milliseconds since the last call.
class Lap {
 public:
  double operator()() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

const std::string* find(const scene::TextChunks& texts, const std::string& keyword) {
  const auto found =
      std::find_if(texts.begin(), texts.end(), [&](const auto& text) { return text.first == keyword; });
  return found == texts.end() ? nullptr : &found->second;
}

}  // namespace

FrameWriter::FrameWriter(const Job& job, const RenderOptions& options, const OutputPattern* pattern,
                         int frames)
    : job_(job), options_(options), pattern_(pattern) {
  if (options.manifest) hashes_.resize(static_cast<std::size_t>(frames));
}

scene::TextChunks FrameWriter::texts(int frame, const std::string& hash) const {
  return {{"Software", std::string("limn ") + LIMN_VERSION},
          {kJobKeyword, job_.text(frame)},
          {kPixelsKeyword, hash}};
}

bool FrameWriter::isThere(int frame, std::string& hash) const {
  scene::PngSummary summary;
  if (pattern_ == nullptr || !scene::inspectPng(pattern_->path(frame), summary)) return false;
  const std::string* job = find(summary.texts, kJobKeyword);
  const std::string* pixels = find(summary.texts, kPixelsKeyword);
  if (job == nullptr || pixels == nullptr || *job != job_.text(frame)) return false;
  hash = *pixels;
  return true;
}

void FrameWriter::write(const Picture& picture, const std::string& hash, WriterTimes& times) {
  Lap lap;
  std::vector<std::uint8_t> png;
  if (!options_.rgba) png = scene::encodePng(picture.image, texts(picture.frame, hash), options_.compression);
  const std::vector<std::uint8_t>& bytes = options_.rgba ? picture.image.rgba : png;
  times.encodeMs = lap();
  if (pattern_->isStandardOutput())
    standardOutput_.run(picture.position, [&] {
      scene::writeAll(STDOUT_FILENO, "standard output", bytes.data(), bytes.size());
    });
  else
    scene::writeFileWhole(pattern_->path(picture.frame), bytes.data(), bytes.size());
  times.writeMs = lap();
  times.bytes = bytes.size();
}

void FrameWriter::finish(Picture& picture) {
  WriterTimes times;
  Lap lap;
  const bool writes = pattern_ != nullptr && !picture.existing;
  const bool wantsHash = options_.hash || options_.manifest || (writes && !options_.rgba);
  const std::string hash = picture.existing ? picture.hash : wantsHash ? scene::pixelHash(picture.image) : "";
  times.hashMs = lap();
  if (writes) write(picture, hash, times);
  if (options_.hash)
    standardOutput_.run(picture.position, [&] {
      const std::string line = std::to_string(picture.frame) + " " + hash + "\n";
      scene::writeAll(STDOUT_FILENO, "standard output", line.data(), line.size());
    });

  const std::lock_guard lock(mutex_);
  times_.hashMs += times.hashMs;
  times_.encodeMs += times.encodeMs;
  times_.writeMs += times.writeMs;
  times_.bytes += times.bytes;
  if (!hashes_.empty()) hashes_[static_cast<std::size_t>(picture.position)] = hash;
}

}  // namespace limn::program
