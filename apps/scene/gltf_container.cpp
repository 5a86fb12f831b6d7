// Based on: glTF 2.0 specification, section 4, "GLB File Format Specification".
// Differs in: bytes after the end, chunks whose length is no multiple of four and a second BIN chunk are
// passed over with a notice; the specification forbids them, but what is drawn does not depend on them.
#include "apps/scene/gltf_container.h"

#include <cstring>

#include "apps/scene/load.h"

namespace limn::scene {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

[[noreturn]] void refuse(const std::string& file, std::size_t offset, const std::string& what) {
  throw InputError(file + ": byte " + std::to_string(offset) + ": " + what +
                   "; is it a whole .gltf or .glb file?");
}

std::uint32_t littleEndian32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} | std::uint32_t{bytes[at + 1]} << 8 | std::uint32_t{bytes[at + 2]} << 16 |
         std::uint32_t{bytes[at + 3]} << 24;
}

std::string_view textOf(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The part of the file that the header speaks of.
std::span<const std::uint8_t> checkedExtent(const std::string& file, std::span<const std::uint8_t> bytes,
                                            std::vector<std::string>& notices) {
  if (bytes.size() < kHeaderBytes) refuse(file, bytes.size(), "the GLB header is cut short");
  const std::uint32_t version = littleEndian32(bytes, 4), length = littleEndian32(bytes, 8);
  if (version == 1) throw InputError(file + ": byte 4: glTF 1.0; convert it to glTF 2.0 first");
  if (version != 2) refuse(file, 4, "GLB version " + std::to_string(version) + " instead of 2");
  if (length < kHeaderBytes || length > bytes.size()) {
    refuse(
        file, 8,
        "the header says " + std::to_string(length) + " bytes, the file has " + std::to_string(bytes.size()));
  }
  if (length < bytes.size()) {
    notices.push_back(std::to_string(bytes.size() - length) +
                      " bytes after the end of the GLB were passed over.");
  }
  return bytes.first(length);
}

void takeChunk(const std::string& file, std::uint32_t type, std::size_t offset,
               std::span<const std::uint8_t> data, Container& container, std::vector<std::string>& notices) {
  const bool isFirst = offset == kHeaderBytes + kChunkHeaderBytes;
  if (isFirst != (type == kJson)) {
    if (isFirst) refuse(file, offset - 4, "the first chunk is not JSON");
    refuse(file, offset - 4, "a second JSON chunk");
  }
  if (type == kJson) {
    container.json = textOf(data);
    container.jsonOffset = offset;
  } else if (type == kBinary && !container.binary) {
    container.binary = data;
  } else {
    notices.push_back("A GLB chunk that limn does not know was passed over (byte " + std::to_string(offset) +
                      ").");
  }
}

Container splitGlb(const std::string& file, std::span<const std::uint8_t> whole,
                   std::vector<std::string>& notices) {
  const std::span<const std::uint8_t> bytes = checkedExtent(file, whole, notices);
  Container container;
  std::size_t at = kHeaderBytes;
  if (at == bytes.size()) refuse(file, at, "a GLB without chunks");
  while (at < bytes.size()) {
    if (bytes.size() - at < kChunkHeaderBytes) refuse(file, at, "a chunk header is cut short");
    const std::size_t length = littleEndian32(bytes, at);
    const std::uint32_t type = littleEndian32(bytes, at + 4);
    at += kChunkHeaderBytes;
    if (length > bytes.size() - at) refuse(file, at - 8, "a chunk reaches beyond the end of the file");
    if (length % 4 != 0)
      notices.push_back("A GLB chunk's length is no multiple of four (byte " + std::to_string(at - 8) + ").");
    takeChunk(file, type, at, bytes.subspan(at, length), container, notices);
    at += length;
  }
  return container;
}

}  // namespace

Container splitContainer(const std::string& file, std::span<const std::uint8_t> bytes,
                         std::vector<std::string>& notices) {
  if (bytes.empty()) refuse(file, 0, "the file is empty");
  if (bytes.size() >= 4 && littleEndian32(bytes, 0) == kMagic) return splitGlb(file, bytes, notices);
  Container container;
  container.json = textOf(bytes);
  return container;
}

}  // namespace limn::scene
