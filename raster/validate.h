// What callers may hand over: the rules of raster.h as far as they are checked.
#pragma once

#include <cstdint>
#include <span>

#include "raster/base/workers.h"
#include "raster/raster.h"

namespace limn::raster {

/// All throw std::invalid_argument.
void requireValid(const Vertices& vertices, std::span<const std::uint32_t> indices,
                  std::span<const Part> parts);
void requireValid(const Frame& frame, const Target& target);
/// What a look at each triangle of the streams tells.
void requireValidStreams(const Frame& frame, Workers& workers);

}  // namespace limn::raster
