#include "engine/extraction.hpp"

#include <cmath>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>

namespace touchtrial::engine {
namespace {

/// \throws std::invalid_argument unless `holds`: "<option>: must be <range>, not <value>"
template <typename Value>
void require(bool holds, std::string_view option, std::string_view range, Value value) {
  if (holds) return;
  std::ostringstream message;
  message.imbue(std::locale::classic());
  message << option << ": must be " << range << ", not " << value;
  throw std::invalid_argument(message.str());
}

void check_component(const GaborComponent& component) {
  const double frequency = component.frequency_cycles_per_px;
  require(frequency > 0.0 && frequency <= 0.5, "frequency_cycles_per_px", "in (0, 0.5]", frequency);
  require(std::isfinite(component.direction_deg), "direction_deg", "a finite number",
          component.direction_deg);
}

void check_tv_gabor(const TvGaborOptions& options) {
  require(
      options.lambda >= TvGaborOptions::kMinLambda && options.lambda <= TvGaborOptions::kMaxLambda,
      "lambda", "from 1e-6 to 1e6", options.lambda);
  require(options.gap > 0.0 && std::isfinite(options.gap), "gap", "a finite number above 0",
          options.gap);
  require(options.max_steps >= 1, "max_steps", "at least 1", options.max_steps);
  if (options.automatic) return;
  if (options.components.empty()) {
    throw std::invalid_argument("components: at least one is needed");
  }
  for (const GaborComponent& component : options.components) check_component(component);
}

void check_radius(int radius) {
  require(radius >= 1 && radius <= ExtractionOptions::kMaxRadius, "radius", "from 1 to 63", radius);
}

void check_order(double order) {
  require(order >= 0.0 && order < 1.0, "order", "in [0, 1)", order);
}

void check_levels(int levels) {
  require(levels >= 1 && levels <= ExtractionOptions::kMaxLevels, "levels", "from 1 to 8", levels);
}

void check_sigma(double sigma_px) {
  require(sigma_px > 0.0 && sigma_px <= ExtractionOptions::kMaxSigma_px, "sigma", "in (0, 1000]",
          sigma_px);
}

void check_threshold(double threshold_grey) {
  require(threshold_grey >= 0.0 && threshold_grey <= 255.0, "threshold", "from 0 to 255",
          threshold_grey);
}

void check_divisor(double divisor) {
  require(divisor >= ExtractionOptions::kMinDivisor && divisor <= ExtractionOptions::kMaxDivisor,
          "divisor", "from 0.001 to 1e6", divisor);
}

}  // namespace

void check_options(const ExtractionOptions& options) {
  switch (options.method) {
    case Method::adaptive:
      check_levels(options.levels);
      return check_radius(options.radius);
    case Method::fixed:
      check_order(options.order);
      return check_radius(options.radius);
    case Method::tv_gabor:
      return check_tv_gabor(options.tv_gabor);
    case Method::gaussian:
      return check_sigma(options.sigma_px);
    case Method::median:
      check_threshold(options.threshold_grey);
      return check_radius(options.radius);
    case Method::edge:
      return check_divisor(options.divisor);
    case Method::luminance:
      return;
  }
  throw std::invalid_argument("method: not one of the enumeration");
}

}  // namespace touchtrial::engine
