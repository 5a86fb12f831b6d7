// A glTF file in memory: its checked JSON as tinygltf's structures, and the bytes of its buffers and images.
//
// tinygltf checks neither the paths nor the bounds of what a file refers to, so it never sees a buffer or an
// image: limn reads those, checks the JSON before tinygltf gets it (gltf_json.h), and the accessors after it
// (gltf_accessor.h).
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "apps/scene/gltf_json.h"

namespace limn::scene {

/// Bytes that a file may make the loader take, so that a small hostile file stays small.
class Budget {
 public:
  /// For a model whose file and external files hold `inputBytes`.
  explicit Budget(std::size_t inputBytes) : left_(kBase + kPerByte * inputBytes) {}

  /// One more external file of `inputBytes` was read.
  void grow(std::size_t inputBytes) { left_ += kPerByte * inputBytes; }
  /// `bytes` <= left().
  void take(std::size_t bytes) { left_ -= bytes; }
  std::size_t left() const { return left_; }

 private:
  // Whatever the file's size, one picture of 4096 x 4096 pixels with its mip levels; and 256 times the input: a
  // JPEG of a twentieth of a byte per pixel becomes 11 bytes, positions of three bytes positions, normals and tangents
  // of 40. From 64 KiB come at most 192 MiB.
  static constexpr std::size_t kBase = 176U << 20;
  static constexpr std::size_t kPerByte = 256;
  std::size_t left_;
};

struct GltfBuffer {
  std::optional<std::span<const std::uint8_t>> bytes;  ///< absent where the file says not where they are
  /// Of a data URI, or of an external file, which all buffers that name it share; null for neither.
  std::shared_ptr<const std::vector<std::uint8_t>> source;
  std::size_t length = 0;  ///< what the file says; `bytes` are that many
};

struct GltfImage {
  std::string uri;  ///< of an external file, below `folder`, not yet looked for
  std::filesystem::path folder;
  std::vector<std::uint8_t> embedded;  ///< of a data URI
  int bufferView = -1;
};

class GltfDocument {
 public:
  /// Throws InputError.
  GltfDocument(std::string file, std::vector<std::uint8_t> bytes,
               const std::optional<std::filesystem::path>& folder);
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  const std::string& file() const { return file_; }
  [[noreturn]] void refuse(const std::string& place, const std::string& what) const;
  /// Takes `bytes` from the budget or refuses the file.
  void charge(std::size_t bytes, const std::string& place);
  /// The external file `path` (of resolveUri), which holds `inputBytes`, was read: as much more may be made of it, but
  /// not for each time that it is read.
  void grow(const std::filesystem::path& path, std::size_t inputBytes) {
    if (counted_.insert(path).second) budget_.grow(inputBytes);
  }
  /// Of the file and the distinct ones that its buffers refer to.
  std::size_t inputBytes() const { return inputBytes_; }
  /// Refuses the file if `bytes` are not left, without taking them.
  void checkRoom(std::size_t bytes, const std::string& place) const;
  void notice(std::string sentence) { notices.push_back(std::move(sentence)); }

  tinygltf::Model model;  ///< without buffers, images and whatever limn does not know
  std::size_t viewCount =
      0;  ///< the file's; accessors with a bufferView from here on have none and are all zeros
  std::vector<GltfBuffer> buffers;
  std::vector<GltfImage> images;
  std::vector<std::string> notices;

 private:
  void parse(std::size_t jsonOffset, std::string_view text,
             const std::optional<std::filesystem::path>& folder,
             std::optional<std::span<const std::uint8_t>> binary);
  void readBuffers(const nlohmann::json& described, const std::optional<std::filesystem::path>& folder,
                   const std::optional<std::span<const std::uint8_t>>& binary);

  std::string file_;
  std::vector<std::uint8_t> bytes_;
  std::size_t inputBytes_ = 0;
  std::set<std::filesystem::path> counted_;  ///< external files that the budget has grown by
  Budget budget_{0};
};

}  // namespace limn::scene
