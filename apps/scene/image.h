// Pictures in memory and in files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace limn::scene {

/// RGBA8, straight alpha, top row first, rows without gaps.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// What could not be written, with the reason and the remedy. The program ends with exit status 4.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// tEXt chunks in the order given: keyword, text.
using TextChunks = std::vector<std::pair<std::string, std::string>>;

/// PNG bytes: RGBA8, sRGB chunk, text chunks, one fixed filter, zlib level 0 … 12 (libdeflate). The same bytes for the
/// same input everywhere.
std::vector<std::uint8_t> encodePng(const Image& image, const TextChunks& texts, int level);

/// Reads a PNG (any kind, converted to RGBA8). Throws InputError (apps/scene/load.h) naming the file.
Image readPng(const std::string& path, TextChunks* texts = nullptr);

/// Writes a file whole or not at all: a temporary name beside it, then a rename. Throws OutputError.
void writeFileWhole(const std::string& path, const void* bytes, std::size_t count);

/// 32 hexadecimal digits of XXH3-128 as xxh128sum prints it, of the RGBA8 rows.
std::string pixelHash(const Image& image);

}  // namespace limn::scene
