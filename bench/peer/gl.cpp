#include "bench/peer/gl.h"

#include <dlfcn.h>
#include <malloc.h>

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace limn::peer {
namespace {

// From GL/osmesa.h, which cannot be included beside GL/glcorearb.h.
constexpr int kFormat = 0x22, kDepthBits = 0x30, kStencilBits = 0x31, kAccumulationBits = 0x32,
              kProfile = 0x33;
constexpr int kCoreProfile = 0x34, kMajor = 0x36, kMinor = 0x37;
using Function = void (*)();
using CreateContext = void*(const int* attributes, void* shared);
using MakeCurrent = GLboolean(void* context, void* pixels, GLenum type, GLsizei width, GLsizei height);
using GetFunction = Function(const char* name);

void* openLibrary() {
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
    if (void* library = dlopen(name, RTLD_NOW)) return library;
  }
  throw std::runtime_error("cannot open libOSMesa; install libosmesa6");
}

template <class F>
F* find(void* library, const char* name) {
  void* symbol = dlsym(library, name);
  if (symbol == nullptr) throw std::runtime_error(std::string("libOSMesa lacks ") + name);
  return reinterpret_cast<F*>(symbol);
}

}  // namespace

Gl::Gl(int width, int height, int threads, std::vector<std::uint8_t>& pixels) {
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  // llvmpipe gives its bins back after every frame: keep their pages, so that it is not the kernel that is timed.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  void* library = openLibrary();
  constexpr std::array<int, 15> kAttributes{
      kFormat, GL_RGBA, kDepthBits, 24, kStencilBits, 0, kAccumulationBits, 0, kProfile, kCoreProfile, kMajor,
      4,       kMinor,  1,          0};
  void* context = find<CreateContext>(library, "OSMesaCreateContextAttribs")(kAttributes.data(), nullptr);
  if (context == nullptr) throw std::runtime_error("no OpenGL 4.1 core context");
  pixels.assign(std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  if (!find<MakeCurrent>(library, "OSMesaMakeCurrent")(context, pixels.data(), GL_UNSIGNED_BYTE, width,
                                                       height)) {
    throw std::runtime_error("cannot draw into client memory");
  }
  const auto get = find<GetFunction>(library, "OSMesaGetProcAddress");
  // NOLINTNEXTLINE(bugprone-macro-parentheses): a member's name
#define LIMN_GL_LOAD(name, type)                               \
  name = reinterpret_cast<PFNGL##type##PROC>(get("gl" #name)); \
  if (name == nullptr) throw std::runtime_error("OpenGL lacks gl" #name);
  LIMN_GL_FUNCTIONS(LIMN_GL_LOAD)
#undef LIMN_GL_LOAD
}

}  // namespace limn::peer
