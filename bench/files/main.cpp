// limn_png: raw RGBA frames from standard input to PNG files, one after the other, as programs do that know nothing better:
// stb_image_write as it comes, or libpng as it comes. What `limn render` is measured against.
#include <png.h>
#include <stb_image_write.h>

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace {

/// False on any error. Nothing with a destructor lives in here.
bool writeWithLibpng(const char* path, int width, int height, const std::uint8_t* rgba) {
  std::FILE* const file = std::fopen(path, "wb");
  if (file == nullptr) return false;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // the program ends
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (int y = 0; y < height; ++y)
    png_write_row(png, rgba + std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(y));
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return std::fclose(file) == 0;
}

bool writeWithStb(const char* path, int width, int height, const std::uint8_t* rgba) {
  return stbi_write_png(path, width, height, 4, rgba, 4 * width) != 0;
}

}  // namespace

int main(int argc, char** argv) {
  int width = 0, height = 0;
  const std::string_view writer = argc > 1 ? argv[1] : "";
  if (argc != 4 || (writer != "stb" && writer != "libpng") ||
      std::sscanf(argv[2], "%dx%d", &width, &height) != 2 || width < 1 || height < 1) {
    std::fputs("usage: limn_png stb|libpng WxH FOLDER < frames.rgba\n", stderr);
    return 2;
  }
  const auto write = writer == "stb" ? writeWithStb : writeWithLibpng;
  std::vector<std::uint8_t> frame(std::size_t{4} * static_cast<std::size_t>(width) *
                                  static_cast<std::size_t>(height));
  int count = 0;
  while (std::fread(frame.data(), 1, frame.size(), stdin) == frame.size()) {
    const std::string path = std::string(argv[3]) + "/" + std::to_string(++count) + ".png";
    if (!write(path.c_str(), width, height, frame.data())) {
      std::fprintf(stderr, "limn_png: %s could not be written\n", path.c_str());
      return 4;
    }
  }
  return 0;
}
