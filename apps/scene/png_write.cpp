// PNG encoding.
//
// Based on: PNG (Portable Network Graphics) Specification, third edition, W3C 2023.
// RGBA8 goes through stb_image_write with libdeflate as its compressor, because stb's own takes ten times as
// long for a larger file; the chunks that stb does not know are put in afterwards. Its settings are globals:
// the filter is set once, and the level reaches the compressor through a variable of the thread.
#include <libdeflate.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdlib>
#include <memory>
#include <new>
#include <string_view>

#include "apps/scene/image.h"
#include "raster/base/check.h"

namespace {

struct FreeCompressor {
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};

struct ThreadCompressor {
  int level = -1;
  std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor;
};

ThreadCompressor& threadCompressor() {
  thread_local ThreadCompressor compressor;
  return compressor;
}

unsigned char* compressForStb(unsigned char* data, int count, int* outCount, int /*quality*/) {
  libdeflate_compressor* compressor = threadCompressor().compressor.get();
  const std::size_t bound = libdeflate_zlib_compress_bound(compressor, static_cast<std::size_t>(count));
  auto* out = static_cast<unsigned char*>(std::malloc(bound));  // stb frees it
  if (out == nullptr) return nullptr;
  *outCount = static_cast<int>(
      libdeflate_zlib_compress(compressor, data, static_cast<std::size_t>(count), out, bound));
  return out;
}

}  // namespace

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#define STBIW_ZLIB_COMPRESS compressForStb
#define STBIW_CRC32(bytes, count) libdeflate_crc32(0, bytes, static_cast<std::size_t>(count))
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace limn::scene {
namespace {

constexpr std::size_t kAfterHeader = 8 + 12 + 13;  // signature and IHDR
constexpr int kFilter = 2;                         // "Up": smallest at level 1, and as fast as any

void setFilterOnce() {
  static const bool done = [] {
    stbi_write_force_png_filter = kFilter;
    return true;
  }();
  static_cast<void>(done);
}

std::uint8_t* put32(std::uint8_t* out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) *out++ = static_cast<std::uint8_t>(value >> shift);
  return out;
}

void appendChunk(std::vector<std::uint8_t>& out, std::string_view type, std::string_view data) {
  const std::size_t start = out.size();
  out.resize(start + 12 + data.size());
  std::uint8_t* const name = put32(&out[start], static_cast<std::uint32_t>(data.size()));
  std::copy(data.begin(), data.end(), std::copy(type.begin(), type.end(), name));
  put32(name + 4 + data.size(), libdeflate_crc32(0, name, 4 + data.size()));
}

bool isAscii(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

void requireKeywords(const TextChunks& texts) {
  for (const auto& [keyword, text] : texts)
    require(!keyword.empty() && keyword.size() <= 79 && isAscii(keyword),
            "a text chunk's keyword must be 1 to 79 ASCII characters");
}

void appendTexts(std::vector<std::uint8_t>& out, const TextChunks& texts) {
  for (const auto& [keyword, text] : texts) {
    using namespace std::string_literals;
    if (isAscii(text))
      appendChunk(out, "tEXt", keyword + "\0"s + text);
    else  // tEXt is Latin-1; iTXt is UTF-8: not compressed, no language, no translated keyword
      appendChunk(out, "iTXt", keyword + "\0\0\0\0\0"s + text);
  }
}

void requireSize(int width, int height) {
  require(width >= 1 && width <= kLargestSize && height >= 1 && height <= kLargestSize,
          "a picture is 1 to 16384 pixels wide and high");
}

/// libdeflate's level for one of ours: its level 1 takes longer than 2 on pictures, and makes them larger.
int deflateLevel(int level) {
  return level == 0 ? 0 : std::min(level + 1, 12);
}

void useLevel(int level) {
  ThreadCompressor& own = threadCompressor();
  if (own.level == level) return;
  own.compressor.reset(libdeflate_alloc_compressor(deflateLevel(level)));
  if (!own.compressor) throw std::bad_alloc();
  own.level = level;
}

// --- 16 bits, through libpng ---

struct PngWriter {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::vector<std::uint8_t> bytes;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

void appendBytes(png_structp png, png_bytep data, std::size_t count) {
  auto* out = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  out->insert(out->end(), data, data + count);
}

/// False on an error of libpng, which can only be a lack of memory. Nothing with a destructor lives in here.
bool writeRows16(PngWriter& writer, const Image16& image, std::vector<png_text>& texts, int level) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  constexpr int kColorType[5] = {0, PNG_COLOR_TYPE_GRAY, 0, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
  png_set_write_fn(writer.png, &writer.bytes, appendBytes, nullptr);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 16, kColorType[image.channels], PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(writer.png, level);
  png_set_filter(writer.png, 0, PNG_FILTER_UP);
  if (!texts.empty()) png_set_text(writer.png, writer.info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(writer.png, writer.info);
  png_set_swap(writer.png);  // the file has the high byte first
  const std::size_t stride = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  for (int y = 0; y < image.height; ++y)
    png_write_row(writer.png, reinterpret_cast<png_const_bytep>(image.samples.data() +
                                                                static_cast<std::size_t>(y) * stride));
  png_write_end(writer.png, nullptr);
  return true;
}

}  // namespace

std::vector<std::uint8_t> encodePng(const Image& image, const TextChunks& texts, int level) {
  requireSize(image.width, image.height);
  require(
      image.rgba.size() == 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
      "the picture's rows do not match its size");
  require(level >= 0 && level <= kHighestCompression, "the compression level is 0 to 12");
  requireKeywords(texts);
  setFilterOnce();
  useLevel(level);

  int count = 0;
  const std::unique_ptr<unsigned char, decltype(&std::free)> plain(
      stbi_write_png_to_mem(image.rgba.data(), 4 * image.width, image.width, image.height, 4, &count),
      &std::free);
  if (!plain) throw std::bad_alloc();

  std::vector<std::uint8_t> out;
  out.assign(plain.get(), plain.get() + kAfterHeader);
  using namespace std::string_view_literals;
  appendChunk(out, "sRGB", "\0"sv);  // rendering intent: perceptual
  appendTexts(out, texts);
  const std::size_t beforeData = out.size();
  out.resize(beforeData + static_cast<std::size_t>(count) - kAfterHeader);
  std::copy(plain.get() + kAfterHeader, plain.get() + count,
            out.begin() + static_cast<std::ptrdiff_t>(beforeData));
  return out;
}

std::vector<std::uint8_t> encodePng16(const Image16& image, const TextChunks& texts, int level) {
  requireSize(image.width, image.height);
  require(image.channels == 1 || image.channels == 3 || image.channels == 4,
          "16-bit pictures have 1, 3 or 4 channels");
  require(image.samples.size() == static_cast<std::size_t>(image.width) *
                                      static_cast<std::size_t>(image.height) *
                                      static_cast<std::size_t>(image.channels),
          "the picture's rows do not match its size");
  requireKeywords(texts);

  std::vector<png_text> chunks;
  for (const auto& [keyword, text] : texts) {
    png_text chunk{};
    chunk.compression = isAscii(text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(keyword.c_str());  // libpng copies them
    chunk.text = const_cast<char*>(text.c_str());
    chunk.text_length = text.size();
    chunks.push_back(chunk);
  }
  PngWriter writer;
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  if (writer.png != nullptr) writer.info = png_create_info_struct(writer.png);
  if (writer.info == nullptr || !writeRows16(writer, image, chunks, std::clamp(level, 1, 9)))
    throw std::bad_alloc();
  return std::move(writer.bytes);
}

}  // namespace limn::scene
