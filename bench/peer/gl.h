// The part of OpenGL 4.1 that the peer needs, on a context of Mesa's OSMesa that draws into client memory. The library is
// opened at run time, so that building needs headers only.
#pragma once

#include <GL/glcorearb.h>

#include <cstdint>
#include <vector>

namespace limn::peer {

// Name of the function and of its type, for each entry point.
#define LIMN_GL_FUNCTIONS(X)                          \
  X(AttachShader, ATTACHSHADER)                       \
  X(BindBuffer, BINDBUFFER)                           \
  X(BindTexture, BINDTEXTURE)                         \
  X(BindVertexArray, BINDVERTEXARRAY)                 \
  X(BufferData, BUFFERDATA)                           \
  X(BufferSubData, BUFFERSUBDATA)                     \
  X(Clear, CLEAR)                                     \
  X(ClearColor, CLEARCOLOR)                           \
  X(CompileShader, COMPILESHADER)                     \
  X(CreateProgram, CREATEPROGRAM)                     \
  X(CreateShader, CREATESHADER)                       \
  X(DrawElementsInstanced, DRAWELEMENTSINSTANCED)     \
  X(Enable, ENABLE)                                   \
  X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY) \
  X(Finish, FINISH)                                   \
  X(GenBuffers, GENBUFFERS)                           \
  X(GenTextures, GENTEXTURES)                         \
  X(GenVertexArrays, GENVERTEXARRAYS)                 \
  X(GenerateMipmap, GENERATEMIPMAP)                   \
  X(GetError, GETERROR)                               \
  X(GetProgramInfoLog, GETPROGRAMINFOLOG)             \
  X(GetProgramiv, GETPROGRAMIV)                       \
  X(GetShaderInfoLog, GETSHADERINFOLOG)               \
  X(GetShaderiv, GETSHADERIV)                         \
  X(GetString, GETSTRING)                             \
  X(GetUniformLocation, GETUNIFORMLOCATION)           \
  X(LinkProgram, LINKPROGRAM)                         \
  X(ShaderSource, SHADERSOURCE)                       \
  X(TexImage2D, TEXIMAGE2D)                           \
  X(TexParameteri, TEXPARAMETERI)                     \
  X(UniformMatrix4fv, UNIFORMMATRIX4FV)               \
  X(UseProgram, USEPROGRAM)                           \
  X(VertexAttribDivisor, VERTEXATTRIBDIVISOR)         \
  X(VertexAttribPointer, VERTEXATTRIBPOINTER)         \
  X(Viewport, VIEWPORT)

struct Gl {
#define LIMN_GL_MEMBER(name, type) PFNGL##type##PROC name = nullptr;
  LIMN_GL_FUNCTIONS(LIMN_GL_MEMBER)
#undef LIMN_GL_MEMBER

  /// Makes a context whose every finished frame is in `pixels`: RGBA8, bottom row first. `threads` raster threads beside
  /// the calling one; 0 for none. Throws std::runtime_error where there is no such library or context.
  Gl(int width, int height, int threads, std::vector<std::uint8_t>& pixels);
};

}  // namespace limn::peer
