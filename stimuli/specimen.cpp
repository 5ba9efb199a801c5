#include "stimuli/specimen.hpp"

#include "core/random.hpp"

#include <cmath>

namespace touchtrial::stimuli {
namespace {

/// Successive multiples of the golden ratio's fraction fill a range evenly.
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
  const double place = RandomStream(seed_, trait).uniform() + kGoldenStep * exemplar_;
  return spread * (2.0 * (place - std::floor(place)) - 1.0);
}

double Specimen::factor(std::string_view trait, double spread) const {
  const double departure = shift(trait, spread);
  return departure < 0.0 ? 1.0 / (1.0 - departure) : 1.0 + departure;
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
