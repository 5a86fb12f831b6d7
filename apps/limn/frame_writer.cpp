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

scene::TextChunks textsOf(const std::string& job, const std::string& hash) {
  return {{"Software", std::string("limn ") + LIMN_VERSION}, {kJobKeyword, job}, {kPixelsKeyword, hash}};
}

}  // namespace

FrameFile inspectFrame(const std::string& path, const std::string& job, std::string& hash) {
  scene::PngSummary summary;
  if (!scene::inspectPng(path, summary)) return FrameFile::kMissing;
  const std::string* said = find(summary.texts, kJobKeyword);
  const std::string* pixels = find(summary.texts, kPixelsKeyword);
  if (said == nullptr || pixels == nullptr || *said != job) return FrameFile::kOtherJob;
  hash = *pixels;
  return FrameFile::kWhole;
}

FrameWriter::FrameWriter(const Job& job, const RenderOptions& options, const OutputPattern* pattern,
                         int frames, std::size_t triangles)
    : job_(job), options_(options), pattern_(pattern), triangles_(triangles) {
  if (options.manifest && pattern != nullptr) records_.resize(static_cast<std::size_t>(frames));
}

bool FrameWriter::isThere(Picture& picture) const {
  if (pattern_ == nullptr) return false;
  const std::string path = pattern_->path(picture.frame);
  if (inspectFrame(path, job_.text(picture.frame), picture.hash) != FrameFile::kWhole) return false;
  picture.aovHashes.resize(options_.aovs.size());
  for (std::size_t i = 0; i < options_.aovs.size(); ++i) {
    const Aov aov = options_.aovs[i];
    if (inspectFrame(besidePath(path, aovName(aov)), aovJob(picture.frame, aov), picture.aovHashes[i]) !=
        FrameFile::kWhole)
      return false;
  }
  return true;
}

void FrameWriter::writePicture(const Picture& picture, WriterTimes& times) {
  Lap lap;
  std::vector<std::uint8_t> png;
  if (!options_.rgba)
    png = scene::encodePng(picture.image, textsOf(job_.text(picture.frame), picture.hash),
                           options_.compression);
  const std::vector<std::uint8_t>& bytes = options_.rgba ? picture.image.rgba : png;
  times.encodeMs += lap();
  if (pattern_->isStandardOutput())
    standardOutput_.run(picture.position, [&] {
      scene::writeAll(STDOUT_FILENO, "standard output", bytes.data(), bytes.size());
    });
  else
    scene::writeFileWhole(pattern_->path(picture.frame), bytes.data(), bytes.size());
  times.writeMs += lap();
  times.bytes += bytes.size();
}

void FrameWriter::writeAov(Picture& picture, Aov aov, WriterTimes& times) {
  Lap lap;
  scene::TextChunks explained;
  const scene::Image16 image =
      aovImage(aov, picture.planes, picture.image, picture.projection, triangles_, explained);
  picture.aovHashes.push_back(scene::hashBytes(image.samples.data(), 2 * image.samples.size()));
  scene::TextChunks texts = textsOf(aovJob(picture.frame, aov), picture.aovHashes.back());
  texts.insert(texts.end(), explained.begin(), explained.end());
  const std::vector<std::uint8_t> png = scene::encodePng16(image, texts, options_.compression);
  times.encodeMs += lap();
  scene::writeFileWhole(besidePath(pattern_->path(picture.frame), aovName(aov)), png.data(), png.size());
  times.writeMs += lap();
  times.bytes += png.size();
}

void FrameWriter::finish(Picture& picture) {
  try {
    finishOrThrow(picture);
  } catch (...) {
    standardOutput_.abandon();  // whatever failed: its turn will never come
    throw;
  }
}

void FrameWriter::finishOrThrow(Picture& picture) {
  WriterTimes times;
  const bool writes = pattern_ != nullptr && !picture.existing;
  if (!picture.existing) {
    Lap lap;
    const bool wantsHash = options_.hash || options_.manifest || (writes && !options_.rgba);
    picture.hash = wantsHash ? scene::pixelHash(picture.image) : "";
    picture.aovHashes.clear();
    times.hashMs = lap();
  }
  // The picture itself comes last: where it is whole, so are its companions.
  if (writes) {
    for (const Aov aov : options_.aovs) writeAov(picture, aov, times);
    writePicture(picture, times);
  }
  if (options_.hash)
    standardOutput_.run(picture.position, [&] {
      const std::string line = std::to_string(picture.frame) + " " + picture.hash + "\n";
      scene::writeAll(STDOUT_FILENO, "standard output", line.data(), line.size());
    });

  const std::lock_guard lock(mutex_);
  times_.hashMs += times.hashMs;
  times_.encodeMs += times.encodeMs;
  times_.writeMs += times.writeMs;
  times_.bytes += times.bytes;
  if (records_.empty()) return;
  ManifestFrame& record = records_[static_cast<std::size_t>(picture.position)];
  record = {picture.frame, relativeTo(*options_.manifest, pattern_->path(picture.frame)), picture.hash,
            picture.aovHashes};
}

}  // namespace limn::program
