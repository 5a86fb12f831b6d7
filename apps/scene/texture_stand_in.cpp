// Built only while the rasterizer has no textures of its own (apps/scene/CMakeLists.txt): what a scene
// without textures needs to link.
#include "raster/texture.h"

namespace limn::raster {

struct Texture::Data {};
Texture::~Texture() = default;

}  // namespace limn::raster
