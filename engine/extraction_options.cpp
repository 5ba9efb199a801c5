#include "engine/extraction.hpp"

#include <cmath>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>

namespace touchtrial {
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
  if (options.components.empty()) {
    throw std::invalid_argument("components: at least one is needed");
  }
  for (const GaborComponent& component : options.components) check_component(component);
}

}  // namespace

void check_options(const ExtractionOptions& options) {
  switch (options.method) {
    case Method::fixed:
      require(options.order >= 0.0 && options.order < 1.0, "order", "in [0, 1)", options.order);
      [[fallthrough]];
    case Method::adaptive:
      require(options.radius >= 1 && options.radius <= ExtractionOptions::kMaxRadius, "radius",
              "from 1 to 7", options.radius);
      return;
    case Method::tv_gabor:
      check_tv_gabor(options.tv_gabor);
      return;
  }
  throw std::invalid_argument("method: not one of the enumeration");
}

}  // namespace touchtrial
