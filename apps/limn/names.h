// The words of the command line for the choices of the library, each at the place of its enumerator.
#pragma once

#include <string>
#include <vector>

namespace limn::program {

inline const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = {"flat", "patches", "curves", "pn"};
  return names;
}
inline const std::vector<std::string>& silhouettenessNames() {
  static const std::vector<std::string> names = {"edge", "contour", "crossing"};
  return names;
}
inline const std::vector<std::string>& tangentsNames() {
  static const std::vector<std::string> names = {"projected", "circular", "geodesic"};
  return names;
}
inline const std::vector<std::string>& shadingNormalsNames() {
  static const std::vector<std::string> names = {"linear", "quadratic"};
  return names;
}

/// In the order in which they are drawn.
inline const std::vector<std::string>& overlayNames() {
  static const std::vector<std::string> names = {"wire", "features", "edges", "contour"};
  return names;
}

}  // namespace limn::program
