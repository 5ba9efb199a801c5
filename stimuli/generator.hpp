/// \file The default pictures: seeded, irregular, made by this program, so that no study depends on
/// anybody's photographs. Each is a height map with light and shadow from one lamp.
#pragma once

#include "core/plane.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace touchtrial::stimuli {

/// The seed of the set that comes with the program.
inline constexpr std::uint64_t kDefaultStimuliSeed = 31875542;
/// Side of a default picture, pixels.
inline constexpr int kDefaultStimulusSizePx = 500;
inline constexpr int kMinStimulusSizePx = 16;
inline constexpr int kMaxStimulusSizePx = 4096;
/// Most exemplars of a label.
inline constexpr int kMaxStimulusExemplars = 1000;
/// Grows whenever a seed starts to mean another picture.
inline constexpr int kGeneratorVersion = 2;

/// What a picture is for. An object lies on a plain ground; all others fill the picture.
enum class StimulusKind {
  texture,   ///< a class to tell from others
  object,    ///< an outline, with a texture on it
  material,  ///< what an object is made of, without its outline
  practice,  ///< a texture that is no class, to get used to the device with
  flat,      ///< nothing to feel: for catch trials
};

/// "texture", "object", "material", "practice" or "flat".
[[nodiscard]] std::string_view name_of(StimulusKind kind);
[[nodiscard]] std::optional<StimulusKind> stimulus_kind_from_name(std::string_view name);

/// A picture that the generator can make.
struct StimulusRecipe {
  std::string_view label;  ///< unique; names files and, in studies, classes
  StimulusKind kind = StimulusKind::texture;
  std::string_view description;
};

/// All recipes: the five textures, the four objects, the four materials in the objects' order, the
/// three practice textures, the flat one.
[[nodiscard]] std::span<const StimulusRecipe> stimulus_recipes();

/// How many exemplars the set that comes with the program has: five of the textures, one of the
/// others.
[[nodiscard]] int shipped_exemplars(StimulusKind kind);

/// Makes one picture. The same label, seed, size and exemplar give the same pixels. Exemplar 1 is
/// as the recipe describes it; further ones are other surfaces, and differ in scale, turn, wear,
/// lamp and exposure as photographs of one material do. Textures keep the size of their features
/// whatever the size of the picture; objects grow with it.
/// \param label  of one of `stimulus_recipes()`
/// \param size_px  side of the square picture, kMinStimulusSizePx .. kMaxStimulusSizePx
/// \param exemplar  1 .. kMaxStimulusExemplars
/// \return mean grey level, of an object without its ground, about 105 to 140
/// \throws UsageError if there is no such label or the size or exemplar is out of range
/// Thread-safe. Takes about a second for 500 pixels.
[[nodiscard]] GreyImage generate_stimulus(std::string_view label, std::uint64_t seed,
                                          int size_px = kDefaultStimulusSizePx, int exemplar = 1);

}  // namespace touchtrial::stimuli
