// Pictures in memory and in files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/scene/output_file.h"

namespace limn::scene {

/// RGBA8, straight alpha, top row first, rows without gaps.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// 16 bits per sample, top row first, rows without gaps: 1 (grey), 3 (RGB) or 4 (RGBA) samples per pixel.
struct Image16 {
  int width = 0, height = 0, channels = 1;
  std::vector<std::uint16_t> samples;
};

/// Text chunks in the order given: keyword (1 … 79 characters of ASCII) and text (UTF-8).
using TextChunks = std::vector<std::pair<std::string, std::string>>;

inline constexpr int kLargestSize = 16384;  ///< pixels, in width and in height
inline constexpr int kHighestCompression = 12;

/// PNG bytes: RGBA8, sRGB chunk, text chunks, one fixed filter, compression level 0 (none), 1 (fast) … 12 (small). The same
/// bytes for the same input everywhere. Any number of threads may encode at a time. Throws
/// std::invalid_argument for sizes outside 1 … 16384 and other levels, std::bad_alloc.
std::vector<std::uint8_t> encodePng(const Image& image, const TextChunks& texts, int level);

/// The same for 16-bit images, through libpng (zlib level 1 … 9).
std::vector<std::uint8_t> encodePng16(const Image16& image, const TextChunks& texts, int level);

/// Reads a PNG (any kind, converted to RGBA8; 16-bit samples are rounded). Throws InputError
/// (apps/scene/load.h) naming the file: not a PNG, damaged, or larger than 16384 pixels.
Image readPng(const std::string& path);

/// Decodes a PNG row by row, so that the picture is never in memory as a whole unless it is interlaced. Errors as
/// readPng, where they are met; `name` is what messages call the file. Borrows `bytes`.
class PngRows {
 public:
  PngRows(const std::string& name, std::span<const std::uint8_t> bytes);
  ~PngRows();
  PngRows(const PngRows&) = delete;
  PngRows& operator=(const PngRows&) = delete;

  int width() const;
  int height() const;
  bool isInterlaced() const;
  /// The next row from the top, RGBA8, 4 · width bytes; at most height() times.
  void next(std::span<std::uint8_t> row);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The same as readPng, converted to RGBA with 16 bits per sample (8-bit samples times 257). `is16` says what the file
/// has.
Image16 readPng16(const std::string& path, bool* is16 = nullptr);

/// What a PNG says of itself, read without decoding it.
struct PngSummary {
  int width = 0, height = 0;
  TextChunks texts;
};

/// Walks the chunks of a PNG file and checks every checksum and the end. False if the file is missing,
/// damaged or cut.
bool inspectPng(const std::string& path, PngSummary& summary);

/// 32 hexadecimal digits of XXH3-128 as xxh128sum prints it.
std::string hashBytes(const void* bytes, std::size_t count);

/// hashBytes of the RGBA8 rows.
std::string pixelHash(const Image& image);

}  // namespace limn::scene
