// limn verify: the frames of a run, cut into shards or not, are all there, whole, and of one job.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "apps/limn/aov.h"
#include "apps/limn/commands.h"
#include "apps/limn/frame_writer.h"
#include "apps/limn/manifest.h"
#include "apps/limn/pattern.h"
#include "apps/limn/terminal.h"
#include "apps/limn/values.h"
#include "apps/scene/image.h"
#include "apps/scene/load.h"
#include "raster/base/workers.h"

namespace limn::program {
namespace {

constexpr std::size_t kMostMessages = 20;

/// What is wrong with one frame; both empty if it is right.
struct Finding {
  std::string broken;     ///< missing, damaged or of another job
  std::string different;  ///< whole, but with other pixels than the manifest says
};

/// One frame of one manifest.
struct Entry {
  const Manifest* manifest;
  std::string path;
  const ManifestFrame* frame;
};

Finding checkRows(const Entry& entry) {
  std::ifstream file(entry.path, std::ios::binary);
  if (!file) return {entry.path + ": is missing", ""};
  std::ostringstream bytes;
  bytes << file.rdbuf();
  const std::string rows = bytes.str();
  if (rows.size() !=
      4 * static_cast<std::size_t>(entry.manifest->width) * static_cast<std::size_t>(entry.manifest->height))
    return {entry.path + ": has not the size of a frame", ""};
  if (scene::hashBytes(rows.data(), rows.size()) != entry.frame->pixels)
    return {"", entry.path + ": has other pixels than the manifest says"};
  return {};
}

Finding checkPng(const Entry& entry) {
  std::string job = entry.manifest->job + " --frames " + std::to_string(entry.frame->frame);
  std::string hash;
  switch (inspectFrame(entry.path, job, hash)) {
    case FrameFile::kMissing:
      return {entry.path + ": is missing or damaged", ""};
    case FrameFile::kOtherJob:
      return {entry.path + ": is of another job", ""};
    case FrameFile::kWhole:
      break;
  }
  if (scene::pixelHash(scene::readPng(entry.path)) != entry.frame->pixels)
    return {"", entry.path + ": has other pixels than the manifest says"};
  for (std::size_t i = 0; i < entry.manifest->aovs.size(); ++i) {
    const std::string& kind = entry.manifest->aovs[i];
    const std::string path = besidePath(entry.path, kind);
    if (inspectFrame(path, job + " --aov " + kind, hash) != FrameFile::kWhole)
      return {path + ": is missing, damaged or of another job", ""};
    if (hash != entry.frame->aovs[i]) return {"", path + ": has other values than the manifest says"};
  }
  return {};
}

Finding check(const Entry& entry) {
  try {
    return entry.manifest->rgba ? checkRows(entry) : checkPng(entry);
  } catch (const scene::InputError& error) {
    return {error.what(), ""};
  }
}

/// All manifests must tell of one run.
void requireOneJob(const std::vector<Manifest>& manifests, const std::vector<std::string>& paths) {
  for (std::size_t i = 1; i < manifests.size(); ++i)
    if (manifests[i].job != manifests[0].job || manifests[i].list != manifests[0].list ||
        manifests[i].aovs != manifests[0].aovs)
      throw scene::InputError(paths[i] + ": /job or /list: is another run than that of " + paths[0] +
                              "; verify the manifests of one run together");
}

class Report {
 public:
  void add(const std::string& message) {
    if (++count_ <= kMostMessages) printMessage(message);
  }
  ~Report() {
    if (count_ > kMostMessages) printMessage("and " + std::to_string(count_ - kMostMessages) + " more");
  }
  Report() = default;
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

 private:
  std::size_t count_ = 0;
};

}  // namespace

int verify(const VerifyOptions& options) {
  std::vector<Manifest> manifests;
  for (const std::string& path : options.manifests) manifests.push_back(Manifest::read(path));
  requireOneJob(manifests, options.manifests);

  std::vector<Entry> entries;
  for (std::size_t i = 0; i < manifests.size(); ++i)
    for (const ManifestFrame& frame : manifests[i].frames)
      entries.push_back({&manifests[i], besideManifest(options.manifests[i], frame.file), &frame});
  std::vector<Finding> findings(entries.size());
  Workers workers(options.threads);
  workers.forBlocks(entries.size(), 1,
                    [&](std::size_t i, std::size_t, int) { findings[i] = check(entries[i]); });

  Report report;
  std::size_t broken = 0, different = 0;
  std::map<int, ManifestFrame> merged;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto [known, isNew] = merged.emplace(entries[i].frame->frame, *entries[i].frame);
    if (!isNew && known->second.pixels != entries[i].frame->pixels)
      findings[i].different = entries[i].path + ": two manifests say different pixels of this frame";
    for (const std::string* message : {&findings[i].broken, &findings[i].different})
      if (!message->empty()) report.add(*message);
    broken += findings[i].broken.empty() ? 0 : 1;
    different += findings[i].different.empty() ? 0 : 1;
  }
  const FrameList list = FrameList::parse(manifests.front().list);
  std::size_t missing = 0;
  for (int i = 0; i < list.count(); ++i)
    if (!merged.contains(list.at(i))) {
      ++missing;
      report.add("frame " + std::to_string(list.at(i)) + " is in no manifest");
    }

  std::vector<ManifestFrame> frames;
  for (const auto& [number, frame] : merged) frames.push_back(frame);
  if (broken + different + missing > 0) {
    std::cout << broken << " of " << list.count() << " frames missing, damaged or of another job, "
              << different << " with other pixels, " << missing << " in no manifest" << std::endl;
    return broken + missing > 0 ? kBadInput : kDifferent;
  }
  std::cout << frames.size() << (frames.size() == 1 ? " frame" : " frames")
            << ", whole and of one job: " << jobHash(frames) << std::endl;
  return kDone;
}

}  // namespace limn::program
