// Arbitrary output variables: 16-bit pictures of depth, normals and ids beside a frame's own.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/scene/frame.h"
#include "apps/scene/image.h"

namespace limn::program {

enum class Aov { kDepth, kNormal, kId };
const std::string& aovName(Aov aov);

/// "depth,normal,id" or some of them. Throws UsageError.
std::vector<Aov> parseAovs(std::string_view text);
void wantPlanes(const std::vector<Aov>& aovs, scene::Planes& planes);
/// Bytes per pixel that a picture and its planes take.
std::size_t bytesPerPixel(const std::vector<Aov>& aovs);

/// The picture of one plane and the text chunks that explain its values:
///   depth   grey: 65535·(depth - near)/(far - near), 65535 where nothing was drawn
///   normal  RGB: 65535·(n + 1)/2 in view space, mid-grey where nothing was drawn
///   id      grey: triangle of the coarse scene, 65535 where nothing was drawn; with more than 65535 triangles RGB:
///           red + 65536·green, blue 0, white where nothing was drawn
scene::Image16 aovImage(Aov aov, const scene::Planes& planes, const scene::Image& picture,
                        const Projection& projection, std::size_t triangles, scene::TextChunks& texts);

}  // namespace limn::program
