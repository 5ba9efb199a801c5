/// \file The pictures that the generator can make, one function each.
#pragma once

#include "core/plane.hpp"

#include <cstdint>

namespace touchtrial {

/// Each makes a square picture of `size_px` pixels a side. Textures keep the size of their features
/// whatever the size of the picture; objects grow with it.
[[nodiscard]] GreyImage make_bark(std::uint64_t seed, int size_px);
[[nodiscard]] GreyImage make_cloth(std::uint64_t seed, int size_px);
[[nodiscard]] GreyImage make_pebbles(std::uint64_t seed, int size_px);
[[nodiscard]] GreyImage make_straw(std::uint64_t seed, int size_px);
[[nodiscard]] GreyImage make_brick(std::uint64_t seed, int size_px);
[[nodiscard]] GreyImage make_basket(std::uint64_t seed, int size_px);
[[nodiscard]] GreyImage make_leaf(std::uint64_t seed, int size_px);
[[nodiscard]] GreyImage make_shell(std::uint64_t seed, int size_px);
[[nodiscard]] GreyImage make_log(std::uint64_t seed, int size_px);

}  // namespace touchtrial
