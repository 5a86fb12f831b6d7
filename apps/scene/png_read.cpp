// PNG decoding through libpng, with hard limits: the files may come from anywhere.
#include <libdeflate.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

#include "apps/scene/image.h"
#include "apps/scene/input_file.h"
#include "apps/scene/load.h"
#include "raster/base/check.h"

namespace limn::scene {
namespace {

constexpr std::uint8_t kSignature[8] = {137, 80, 78, 71, 13, 10, 26, 10};
constexpr std::size_t kChunkOverhead = 12;       // length, type, checksum
constexpr std::size_t kLargestExpansion = 1032;  // of deflate: 258 bytes from 2 bits
constexpr std::size_t kLargestAncillaryChunk = 8U << 20;

std::uint32_t bigEndian32(const std::uint8_t* p) {
  return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | p[3];
}

/// Everything that libpng's jumps pass over: it must outlive them.
struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::span<const std::uint8_t> rest;
  std::string message;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

PngReader& readerOf(png_structp png) {
  return *static_cast<PngReader*>(png_get_error_ptr(png));
}

void onError(png_structp png, png_const_charp message) {
  readerOf(png).message = message;
  png_longjmp(png, 1);
}

void onWarning(png_structp /*png*/, png_const_charp /*message*/) {}

void takeBytes(png_structp png, png_bytep out, std::size_t count) {
  PngReader& reader = readerOf(png);
  if (count > reader.rest.size()) png_error(png, "the file ends too early");
  std::memcpy(out, reader.rest.data(), count);
  reader.rest = reader.rest.subspan(count);
}

/// Up to the header; asks libpng for RGBA with `bits` per sample. False on an error.
bool readHeader(PngReader& reader, int bits, int& width, int& height, int& bitDepth) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_user_limits(reader.png, kLargestSize, kLargestSize);
  png_set_chunk_malloc_max(reader.png, kLargestAncillaryChunk);
  png_set_read_fn(reader.png, &reader, takeBytes);
  png_read_info(reader.png, reader.info);
  width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  bitDepth = png_get_bit_depth(reader.png, reader.info);
  png_set_expand(reader.png);
  if (bits == 16) {
    png_set_expand_16(reader.png);
    png_set_swap(reader.png);
  } else {
    png_set_scale_16(reader.png);
  }
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, bits == 16 ? 0xffff : 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool readRows(PngReader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, reader.info);
  return true;
}

/// One row of a picture that is not interlaced, and after the last one the rest of the file.
bool readRow(PngReader& reader, png_bytep row, bool isLast) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_row(reader.png, row, nullptr);
  if (isLast) png_read_end(reader.png, reader.info);
  return true;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw InputError(path + ": " + what + "; give a whole PNG file of at most 16384x16384 pixels");
}

std::vector<std::uint8_t> fileOrRefused(const std::string& path) {
  std::optional<std::vector<std::uint8_t>> file = readFileBytes(path);
  if (!file) throw InputError(path + ": cannot be read; is the name right?");
  return std::move(*file);
}

/// Up to the pixels; asks for RGBA with `bits` per sample.
void open(const std::string& path, std::span<const std::uint8_t> file, int bits, PngReader& reader,
          int& width, int& height, int& bitDepth) {
  if (file.size() < sizeof kSignature || std::memcmp(file.data(), kSignature, sizeof kSignature) != 0)
    refuse(path, "is not a PNG file");
  reader.rest = file;
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, onError, onWarning);
  if (reader.png != nullptr) reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) throw std::bad_alloc();
  if (!readHeader(reader, bits, width, height, bitDepth)) refuse(path, "is damaged (" + reader.message + ")");
  // Before memory is taken: so few bytes cannot hold so many pixels (1 bit each at the least).
  if (file.size() * kLargestExpansion <
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height) / 8)
    refuse(path, "is damaged (too short for its size)");
}

/// Decodes into rows of RGBA with `bits` per sample. `allocate(width, height)` returns the place for all of
/// them.
template <class Allocate>
void decode(const std::string& path, std::span<const std::uint8_t> file, int bits, int& bitDepth,
            const Allocate& allocate) {
  PngReader reader;
  int width = 0, height = 0;
  open(path, file, bits, reader, width, height, bitDepth);
  const std::size_t stride = png_get_rowbytes(reader.png, reader.info);
  png_bytep pixels = allocate(width, height);
  std::vector<png_bytep> rows(static_cast<std::size_t>(height));
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = pixels + y * stride;
  if (!readRows(reader, rows.data())) refuse(path, "is damaged (" + reader.message + ")");
}

/// Keyword and text of a tEXt or an uncompressed iTXt chunk; others are passed over.
void collectText(std::string_view type, std::string_view data, TextChunks& texts) {
  const std::size_t end = data.find('\0');
  if (end == std::string_view::npos) return;
  const std::string keyword(data.substr(0, end));
  std::string_view text = data.substr(end + 1);
  if (type == "iTXt") {
    if (text.size() < 4 || text[0] != '\0') return;
    text = text.substr(2);
    for (int field = 0; field < 2; ++field) {  // language, translated keyword
      const std::size_t zero = text.find('\0');
      if (zero == std::string_view::npos) return;
      text = text.substr(zero + 1);
    }
  }
  texts.emplace_back(keyword, text);
}

}  // namespace

Image readPng(const std::string& path) {
  Image image;
  int bitDepth = 0;
  decode(path, fileOrRefused(path), 8, bitDepth, [&](int width, int height) {
    image.width = width;
    image.height = height;
    image.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return png_bytep{image.rgba.data()};
  });
  return image;
}

struct PngRows::State {
  std::string name;
  PngReader reader;
  int width = 0, height = 0, row = 0;
  bool isInterlaced = false;
  std::vector<std::uint8_t> whole;  ///< of an interlaced picture, whose rows come in no order

  void readWhole() {
    const std::size_t stride = 4 * static_cast<std::size_t>(width);
    whole.resize(stride * static_cast<std::size_t>(height));
    std::vector<png_bytep> rows(static_cast<std::size_t>(height));
    for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = whole.data() + y * stride;
    if (!readRows(reader, rows.data())) refuse(name, "is damaged (" + reader.message + ")");
  }
};

PngRows::PngRows(const std::string& name, std::span<const std::uint8_t> bytes)
    : state_(std::make_unique<State>()) {
  state_->name = name;
  int bitDepth = 0;
  open(name, bytes, 8, state_->reader, state_->width, state_->height, bitDepth);
  state_->isInterlaced =
      png_get_interlace_type(state_->reader.png, state_->reader.info) != PNG_INTERLACE_NONE;
}
PngRows::~PngRows() = default;

int PngRows::width() const {
  return state_->width;
}
int PngRows::height() const {
  return state_->height;
}
bool PngRows::isInterlaced() const {
  return state_->isInterlaced;
}

void PngRows::next(std::span<std::uint8_t> row) {
  State& s = *state_;
  require(s.row < s.height && row.size() == 4 * static_cast<std::size_t>(s.width), "no such row");
  const int y = s.row++;
  if (!s.isInterlaced) {
    if (!readRow(s.reader, row.data(), s.row == s.height))
      refuse(s.name, "is damaged (" + s.reader.message + ")");
    return;
  }
  if (y == 0) s.readWhole();
  const std::uint8_t* from = &s.whole[static_cast<std::size_t>(y) * row.size()];
  std::copy(from, from + row.size(), row.begin());
}

Image16 readPng16(const std::string& path, bool* is16) {
  Image16 image;
  int bitDepth = 0;
  decode(path, fileOrRefused(path), 16, bitDepth, [&](int width, int height) {
    image.width = width;
    image.height = height;
    image.channels = 4;
    image.samples.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return reinterpret_cast<png_bytep>(image.samples.data());
  });
  if (is16 != nullptr) *is16 = bitDepth == 16;
  return image;
}

bool inspectPng(const std::string& path, PngSummary& summary) {
  const std::optional<std::vector<std::uint8_t>> bytes = readFileBytes(path);
  if (!bytes || bytes->size() < sizeof kSignature ||
      std::memcmp(bytes->data(), kSignature, sizeof kSignature) != 0)
    return false;
  const std::vector<std::uint8_t>& file = *bytes;
  bool sawData = false;
  for (std::size_t at = sizeof kSignature; file.size() - at >= kChunkOverhead;) {
    const std::size_t length = bigEndian32(&file[at]);
    if (file.size() - at - kChunkOverhead < length) return false;
    const std::uint8_t* type = &file[at + 4];
    if (libdeflate_crc32(0, type, 4 + length) != bigEndian32(type + 4 + length)) return false;
    const std::string_view name(reinterpret_cast<const char*>(type), 4);
    const std::string_view data(reinterpret_cast<const char*>(type + 4), length);
    if (name == "IHDR" && length == 13) {
      summary.width = static_cast<int>(bigEndian32(type + 4));
      summary.height = static_cast<int>(bigEndian32(type + 8));
    } else if (name == "tEXt" || name == "iTXt") {
      collectText(name, data, summary.texts);
    } else if (name == "IDAT") {
      sawData = true;
    }
    at += kChunkOverhead + length;
    if (name == "IEND") return sawData && summary.width > 0 && at == file.size();
  }
  return false;
}

}  // namespace limn::scene
