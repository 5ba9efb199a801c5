#include "stimuli/generator.hpp"

#include "core/errors.hpp"
#include "core/named.hpp"
#include "core/text.hpp"
#include "stimuli/recipes.hpp"

#include <algorithm>
#include <array>

namespace touchtrial::stimuli {
namespace {

using Maker = GreyImage (*)(const Specimen& specimen, int size_px);

constexpr std::array<StimulusRecipe, 17> kRecipes = {{
    {"bark", StimulusKind::texture, "long upright plates of bark with deep furrows"},
    {"cloth", StimulusKind::texture, "plain weave of uneven yarn, lightly rumpled"},
    {"pebbles", StimulusKind::texture, "rounded pebbles of many sizes"},
    {"straw", StimulusKind::texture, "thin stalks that lie over each other, most of them one way"},
    {"brick", StimulusKind::texture, "courses of rough bricks with mortar joints"},
    {"basket", StimulusKind::object, "a round basket of woven rods"},
    {"leaf", StimulusKind::object, "the underside of a leaf with its veins"},
    {"shell", StimulusKind::object, "a ribbed scallop shell"},
    {"log", StimulusKind::object, "the sawn end of a log with its rings"},
    {"wicker", StimulusKind::material, "a wall of woven rods"},
    {"venation", StimulusKind::material, "midrib, side veins and net of a large leaf"},
    {"ribs", StimulusKind::material, "ribs and terraces of growth of a large shell"},
    {"endgrain", StimulusKind::material, "rings and cracks of sawn wood"},
    {"sand", StimulusKind::practice, "ripples of sand that fork and end"},
    {"leather", StimulusKind::practice, "grained leather with wrinkles and pores"},
    {"cork", StimulusKind::practice, "pressed granules of cork"},
    {"flat", StimulusKind::flat, "one grey everywhere"},
}};

constexpr std::array<Maker, kRecipes.size()> kMakers = {
    make_bark,     make_cloth, make_pebbles, make_straw,  make_brick,    make_basket,
    make_leaf,     make_shell, make_log,     make_wicker, make_venation, make_ribs,
    make_endgrain, make_sand,  make_leather, make_cork,   make_flat};

constexpr auto kKindNames =
    std::to_array<Named<StimulusKind>>({{"texture", StimulusKind::texture},
                                        {"object", StimulusKind::object},
                                        {"material", StimulusKind::material},
                                        {"practice", StimulusKind::practice},
                                        {"flat", StimulusKind::flat}});

Maker maker_of(std::string_view label) {
  const auto* const recipe = std::find_if(kRecipes.begin(), kRecipes.end(),
                                          [&](const auto& r) { return r.label == label; });
  if (recipe != kRecipes.end())
    return kMakers.at(static_cast<std::size_t>(recipe - kRecipes.begin()));
  throw UsageError(one_line("no generated stimulus is called \"" + std::string(label) +
                            "\"; choose one of " + listed(kRecipes, ", ", &StimulusRecipe::label)));
}

}  // namespace

std::string_view name_of(StimulusKind kind) {
  return name_in(kKindNames, kind);
}

std::optional<StimulusKind> stimulus_kind_from_name(std::string_view name) {
  return value_in(kKindNames, name);
}

int shipped_exemplars(StimulusKind kind) {
  constexpr int kTextureExemplars = 5;
  return kind == StimulusKind::texture ? kTextureExemplars : 1;
}

GreyImage make_flat(const Specimen& /*specimen*/, int size_px) {
  constexpr std::uint8_t kMiddleGrey = 128;
  return {size_px, size_px, kMiddleGrey};
}

std::span<const StimulusRecipe> stimulus_recipes() {
  return kRecipes;
}

GreyImage generate_stimulus(std::string_view label, std::uint64_t seed, int size_px, int exemplar) {
  const Maker make = maker_of(label);
  if (size_px < kMinStimulusSizePx || size_px > kMaxStimulusSizePx) {
    throw UsageError("a stimulus cannot have a side of " + std::to_string(size_px) +
                     " pixels; choose " + std::to_string(kMinStimulusSizePx) + " to " +
                     std::to_string(kMaxStimulusSizePx));
  }
  if (exemplar < 1 || exemplar > kMaxStimulusExemplars) {
    throw UsageError("there is no exemplar " + std::to_string(exemplar) + "; choose 1 to " +
                     std::to_string(kMaxStimulusExemplars));
  }
  return make(Specimen(seed, exemplar), size_px);
}

}  // namespace touchtrial::stimuli
