// XXH3, 128 bits: https://github.com/Cyan4973/xxHash/blob/v0.8.1/doc/xxhash_spec.md
#define XXH_INLINE_ALL
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
#include <xxhash.h>
#pragma GCC diagnostic pop

#include "apps/scene/image.h"

namespace limn::scene {

std::string hashBytes(const void* bytes, std::size_t count) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes, count));
  std::string digits;
  for (const unsigned char byte : canonical.digest) {
    digits += "0123456789abcdef"[byte >> 4];
    digits += "0123456789abcdef"[byte & 15];
  }
  return digits;
}

std::string pixelHash(const Image& image) {
  return hashBytes(image.rgba.data(), image.rgba.size());
}

}  // namespace limn::scene
