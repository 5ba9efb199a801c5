/// \file The default pictures: seeded, irregular, made by this program, so that no study depends on
/// anybody's photographs. Each is a height map with light and shadow from one lamp.
#pragma once

#include "core/plane.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace touchtrial {

/// The seed of the set that comes with the program.
inline constexpr std::uint64_t kDefaultStimuliSeed = 31875542;
/// Side of a default picture, pixels.
inline constexpr int kDefaultStimulusSizePx = 500;
inline constexpr int kMinStimulusSizePx = 16;
inline constexpr int kMaxStimulusSizePx = 4096;
/// Grows whenever a seed starts to mean another picture.
inline constexpr int kGeneratorVersion = 1;

/// A texture fills the picture; an object lies on a plain ground.
enum class StimulusKind { texture, object };

/// "texture" or "object".
[[nodiscard]] std::string_view name_of(StimulusKind kind);

/// A picture that the generator can make.
struct StimulusRecipe {
  std::string_view label;  ///< unique; names files and, in studies, classes
  StimulusKind kind = StimulusKind::texture;
  std::string_view description;
};

/// All recipes: the five textures, then the four objects.
[[nodiscard]] std::span<const StimulusRecipe> stimulus_recipes();

/// Makes one picture. The same label, seed and size give the same pixels. Textures keep the size of
/// their features whatever the size of the picture; objects grow with it.
/// \param label  of one of `stimulus_recipes()`
/// \param size_px  side of the square picture, kMinStimulusSizePx .. kMaxStimulusSizePx
/// \return mean grey level of a texture, or of an object without its ground, about 110 to 130
/// \throws UsageError if there is no such label or the size is out of range
/// Thread-safe. Takes about a second for 500 pixels.
[[nodiscard]] GreyImage generate_stimulus(std::string_view label, std::uint64_t seed,
                                          int size_px = kDefaultStimulusSizePx);

}  // namespace touchtrial
