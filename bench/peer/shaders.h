// The grid scene's light and shading in GLSL: ambient and diffuse of the base colour and a highlight, in view space.
#pragma once

namespace limn::peer {

inline constexpr const char* kVersion = "#version 410 core\n";

inline constexpr const char* kVertexShader = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texcoord;
layout(location = 3) in mat4 modelToView;  // of the copy, a similarity
uniform mat4 projection;
out vec3 viewPosition;
out vec3 viewNormal;
out vec2 uv;
void main() {
  vec4 placed = modelToView * vec4(position, 1.0);
  viewPosition = placed.xyz;
  viewNormal = mat3(modelToView) * normal;
  uv = texcoord;
  gl_Position = projection * placed;
}
)";

inline constexpr const char* kFragmentShader = R"(
in vec3 viewPosition;
in vec3 viewNormal;
in vec2 uv;
#ifdef TEXTURED
uniform sampler2D baseColor;
#endif
out vec4 color;
void main() {
  const vec3 toLight = vec3(0.36, 0.48, 0.8);
  vec3 n = normalize(viewNormal);
  vec3 h = normalize(toLight + normalize(-viewPosition));
#ifdef TEXTURED
  vec3 base = texture(baseColor, uv).rgb;
#else
  vec3 base = vec3(0.85, 0.55, 0.30);
#endif
  float s = max(dot(n, h), 0.0);
  for (int squaring = 0; squaring < 5; ++squaring) s *= s;  // the 32nd power
  color = vec4(base * (0.15 + 0.75 * max(dot(n, toLight), 0.0)) + 0.4 * s, 1.0);
}
)";

}  // namespace limn::peer
