/// \file The default pictures: irregular, and generated from a seed, so that studies do not depend
/// on third-party photographs. Each is a height map lit by one lamp.
#pragma once

#include "core/plane.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace touchtrial::stimuli {

/// The seed of the shipped set.
inline constexpr std::uint64_t kDefaultStimuliSeed = 31875542;
/// Side of a default picture, pixels.
inline constexpr int kDefaultStimulusSizePx = 500;
inline constexpr int kMinStimulusSizePx = 16;
inline constexpr int kMaxStimulusSizePx = 4096;
/// Maximum number of exemplars of a label.
inline constexpr int kMaxStimulusExemplars = 1000;
/// Incremented whenever the pictures of a given seed change.
inline constexpr int kGeneratorVersion = 2;

/// The use of a picture. Objects lie on a plain ground; all others fill the picture.
enum class StimulusKind {
  texture,   ///< a class to distinguish from others
  object,    ///< an outline with a texture on it
  material,  ///< the material of an object, without its outline
  practice,  ///< a texture outside the classes, to get used to the device
  flat,      ///< nothing to feel: for catch trials
};

/// \return "texture", "object", "material", "practice" or "flat"
[[nodiscard]] std::string_view name_of(StimulusKind kind);
/// \return the kind of that name, or nothing
[[nodiscard]] std::optional<StimulusKind> stimulus_kind_from_name(std::string_view name);

/// A picture that can be generated.
struct StimulusRecipe {
  std::string_view label;  ///< unique; names files and, in studies, classes
  StimulusKind kind = StimulusKind::texture;
  std::string_view description;
};

/// All recipes: the five textures, the four objects, the four materials in the objects' order, the
/// three practice textures, the flat one.
[[nodiscard]] std::span<const StimulusRecipe> stimulus_recipes();

/// The number of exemplars of a label in the shipped set: five per texture, otherwise one.
[[nodiscard]] int shipped_exemplars(StimulusKind kind);

/// Generates one picture. The same label, seed, size and exemplar give the same pixels. Exemplar 1
/// follows the recipe exactly; further exemplars are other surfaces and vary in scale, rotation,
/// wear, lamp and exposure, like photographs of one material. Texture features do not depend on the
/// size of the picture; objects scale with it. Thread-safe. Takes about a second for 500 pixels.
/// \param label  a label of `stimulus_recipes()`
/// \param size_px  side of the square picture, kMinStimulusSizePx .. kMaxStimulusSizePx
/// \param exemplar  1 .. kMaxStimulusExemplars
/// \return a picture with a mean grey level of about 105 to 140 (for objects: without the ground)
/// \throws UsageError if there is no such label, or the size or exemplar is out of range
[[nodiscard]] GreyImage generate_stimulus(std::string_view label, std::uint64_t seed,
                                          int size_px = kDefaultStimulusSizePx, int exemplar = 1);

}  // namespace touchtrial::stimuli
