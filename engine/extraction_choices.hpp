/// \file What the methods leave to choose besides numbers, with the words of
/// study files and of the command line. Source: docs/method.md, "Options" and
/// "Controls".
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace touchtrial::engine {

/// What the fractional mask sums to, and so how strong a texture is.
enum class Norm {
  additive,  ///< T as it is
  sum,       ///< T / S_K: the classical mask, divided by its sum; up to (1 - S) / S times the image
  none  ///< T + S_K (I - mean of the image): the mask as it is, which keeps the image's shading
};

/// How a texture becomes an 8-bit picture. Forces are made from 128 + T whatever is chosen.
enum class Mapping {
  offset,  ///< 128 + T
  abs,     ///< |T|
  stretch  ///< from 0 at the texture's minimum to 255 at its maximum; all 0 if it is flat
};

/// How the slope of a sub-band is measured along one axis.
enum class Gradient {
  sobel,    ///< [-1 0 1] across, [1 2 1] along, not normalised
  prewitt,  ///< [-1 0 1] across, [1 1 1] along, not normalised
  central   ///< half the difference of the two neighbours
};

/// How the slopes of all sub-bands become one number.
enum class Combine {
  sum,
  l2,  ///< root of the sum of squares
  max
};

/// What a texture becomes to serve as its own control.
enum class Control {
  none,            ///< the texture as it is
  phase_scrambled  ///< its spectrum without its structure: random phases
};

/// In the order of the enumerations.
inline constexpr std::array<std::string_view, 3> kNormNames = {"additive", "sum", "none"};
inline constexpr std::array<std::string_view, 3> kMappingNames = {"offset", "abs", "stretch"};
inline constexpr std::array<std::string_view, 3> kGradientNames = {"sobel", "prewitt", "central"};
inline constexpr std::array<std::string_view, 3> kCombineNames = {"sum", "l2", "max"};
inline constexpr std::array<std::string_view, 2> kControlNames = {"none", "phase-scrambled"};

/// The place of a word in one of the tables above, as a value of its enumeration.
template <typename Choice, std::size_t size>
[[nodiscard]] constexpr std::optional<Choice> choice_named(
    const std::array<std::string_view, size>& names, std::string_view name) {
  for (std::size_t i = 0; i < size; ++i) {
    if (names[i] == name) return static_cast<Choice>(i);
  }
  return std::nullopt;
}

/// The word for a value.
template <typename Choice, std::size_t size>
[[nodiscard]] constexpr std::string_view name_among(const std::array<std::string_view, size>& names,
                                                    Choice choice) {
  return names.at(static_cast<std::size_t>(choice));
}

}  // namespace touchtrial::engine
