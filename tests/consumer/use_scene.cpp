// A built-in model from loading to the hash of its picture.
#include <cstdio>

#include "apps/scene/frame.h"
#include "apps/scene/load.h"

int main() {
  using namespace limn::scene;
  const Scene scene = load("builtin:pawn");
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  const Sphere bounds = boundingSphere(scene, pose);
  const CameraView camera = makeCamera(frameSphere(bounds, 160, 100, 30, 20, 1, 30, 0), bounds, 160, 100);
  FrameDrawer drawer(scene, 2);
  Image image;
  drawer.draw(pose, camera, {}, image);
  std::printf("%s\n", pixelHash(image).c_str());
  return image.rgba.size() == 160 * 100 * 4 ? 0 : 1;
}
