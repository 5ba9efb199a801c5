#include "stimuli/specimen.hpp"

#include "core/random.hpp"

#include <cmath>

namespace touchtrial::stimuli {
namespace {

/// Multiples of the golden ratio's fraction fill a range evenly.
constexpr double kGoldenStep = 0.6180339887498949;

}  // namespace

Specimen::Specimen(std::uint64_t seed, int exemplar)
    : seed_(seed),
      noise_seed_(
          exemplar == 1
              ? seed
              : RandomStream(seed, "exemplar", static_cast<std::uint64_t>(exemplar)).bits()),
      exemplar_(exemplar) {}

double Specimen::shift(std::string_view trait, double spread) const {
  if (exemplar_ == 1) return 0.0;
  const double position = RandomStream(seed_, trait).uniform() + kGoldenStep * exemplar_;
  return spread * (2.0 * (position - std::floor(position)) - 1.0);
}

double Specimen::factor(std::string_view trait, double spread) const {
  const double deviation = shift(trait, spread);
  return deviation < 0.0 ? 1.0 / (1.0 - deviation) : 1.0 + deviation;
}

Vec2 Specimen::turn(std::string_view trait, double spread) const {
  const double slope = shift(trait, spread);
  const double length = std::sqrt(1.0 + slope * slope);
  return {1.0 / length, slope / length};
}

View view_of(const Specimen& specimen, const ViewSpread& spread) {
  return {specimen.factor("view/scale", spread.scale), specimen.turn("view/turn", spread.turn),
          specimen.factor("view/relief", spread.relief)};
}

}  // namespace touchtrial::stimuli
