#include "stimuli/generator.hpp"

#include "core/errors.hpp"
#include "stimuli/recipes.hpp"

#include <algorithm>
#include <array>

namespace touchtrial {
namespace {

using Maker = GreyImage (*)(std::uint64_t seed, int size_px);

constexpr std::array<StimulusRecipe, 9> kRecipes = {{
    {"bark", StimulusKind::texture, "long upright plates of bark with deep furrows"},
    {"cloth", StimulusKind::texture, "plain weave of uneven yarn, lightly rumpled"},
    {"pebbles", StimulusKind::texture, "rounded pebbles of many sizes"},
    {"straw", StimulusKind::texture, "thin stalks that lie over each other, most of them one way"},
    {"brick", StimulusKind::texture, "courses of rough bricks with mortar joints"},
    {"basket", StimulusKind::object, "a round basket of woven rods"},
    {"leaf", StimulusKind::object, "the underside of a leaf with its veins"},
    {"shell", StimulusKind::object, "a ribbed scallop shell"},
    {"log", StimulusKind::object, "the sawn end of a log with its rings"},
}};
constexpr std::array<Maker, kRecipes.size()> kMakers = {make_bark,  make_cloth, make_pebbles,
                                                        make_straw, make_brick, make_basket,
                                                        make_leaf,  make_shell, make_log};

Maker maker_of(std::string_view label) {
  const auto recipe = std::find_if(kRecipes.begin(), kRecipes.end(),
                                   [&](const StimulusRecipe& r) { return r.label == label; });
  if (recipe != kRecipes.end())
    return kMakers.at(static_cast<std::size_t>(recipe - kRecipes.begin()));
  std::string labels;
  for (const StimulusRecipe& r : kRecipes)
    labels += (labels.empty() ? "" : ", ") + std::string(r.label);
  throw UsageError(one_line("no generated stimulus is called \"" + std::string(label) +
                            "\"; choose one of " + labels));
}

}  // namespace

std::string_view name_of(StimulusKind kind) {
  return kind == StimulusKind::texture ? "texture" : "object";
}

std::span<const StimulusRecipe> stimulus_recipes() {
  return kRecipes;
}

GreyImage generate_stimulus(std::string_view label, std::uint64_t seed, int size_px) {
  const Maker make = maker_of(label);
  if (size_px < kMinStimulusSizePx || size_px > kMaxStimulusSizePx) {
    throw UsageError("a stimulus of " + std::to_string(size_px) +
                     " pixels a side cannot be made; choose " + std::to_string(kMinStimulusSizePx) +
                     " to " + std::to_string(kMaxStimulusSizePx));
  }
  return make(seed, size_px);
}

}  // namespace touchtrial
