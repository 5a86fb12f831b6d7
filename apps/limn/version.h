// "limn 0.1.0" and what it is built on.
#pragma once

#include <string>

namespace limn::program {

std::string versionText();

}  // namespace limn::program
