#include "engine/extraction_options.hpp"

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

struct MethodEntry {
  std::string_view name;
  std::vector<Parameter> parameters;  ///< in the order in which they are checked
};

/// One entry per method, in the order of the enumeration.
const std::vector<MethodEntry>& method_table() {
  using enum Parameter;
  static const std::vector<MethodEntry> table = {
      {"adaptive", {levels, radius, norm, gradient, combine}},
      {"fixed", {order, radius, norm}},
      {"tv-gabor", {lambda, gap, max_steps, components}},
      {"gaussian", {sigma}},
      {"median", {threshold, radius}},
      {"edge", {divisor}},
      {"luminance", {}},
  };
  return table;
}

/// \throws std::invalid_argument unless `holds`: "<parameter>: must be <range>, not <value>"
template <typename Value>
void require(bool holds, std::string_view parameter, std::string_view range, Value value) {
  if (holds) return;
  std::ostringstream message;
  message.imbue(std::locale::classic());
  message << parameter << ": must be " << range << ", not " << value;
  throw std::invalid_argument(message.str());
}

void check_components(const TvGaborOptions& options) {
  if (options.automatic) return;
  if (options.components.empty()) {
    throw std::invalid_argument("components: at least one is needed");
  }
  for (const auto& [frequency, direction_deg] : options.components) {
    require(frequency > 0.0 && frequency <= 0.5, "frequency_cycles_per_px", "in (0, 0.5]",
            frequency);
    require(std::isfinite(direction_deg), "direction_deg", "a finite number", direction_deg);
  }
}

void check_parameter(Parameter parameter, const ExtractionOptions& options) {
  using Options = ExtractionOptions;
  const TvGaborOptions& tv_gabor = options.tv_gabor;
  switch (parameter) {
    case Parameter::radius:
      return require(options.radius >= 1 && options.radius <= Options::kMaxRadius, "radius",
                     "from 1 to 63", options.radius);
    case Parameter::order:
      return require(options.order >= 0.0 && options.order < 1.0, "order", "in [0, 1)",
                     options.order);
    case Parameter::levels:
      return require(options.levels >= 1 && options.levels <= Options::kMaxLevels, "levels",
                     "from 1 to 8", options.levels);
    case Parameter::sigma:
      return require(options.sigma_px > 0.0 && options.sigma_px <= Options::kMaxSigma_px, "sigma",
                     "in (0, 1000]", options.sigma_px);
    case Parameter::threshold:
      return require(options.threshold_grey >= 0.0 && options.threshold_grey <= 255.0, "threshold",
                     "from 0 to 255", options.threshold_grey);
    case Parameter::divisor:
      return require(
          options.divisor >= Options::kMinDivisor && options.divisor <= Options::kMaxDivisor,
          "divisor", "from 0.001 to 1e6", options.divisor);
    case Parameter::lambda:
      return require(tv_gabor.lambda >= TvGaborOptions::kMinLambda &&
                         tv_gabor.lambda <= TvGaborOptions::kMaxLambda,
                     "lambda", "from 1e-6 to 1e6", tv_gabor.lambda);
    case Parameter::gap:
      return require(tv_gabor.gap > 0.0 && std::isfinite(tv_gabor.gap), "gap",
                     "a finite number above 0", tv_gabor.gap);
    case Parameter::max_steps:
      return require(tv_gabor.max_steps >= 1, "max_steps", "at least 1", tv_gabor.max_steps);
    case Parameter::components:
      return check_components(tv_gabor);
    case Parameter::norm:
    case Parameter::gradient:
    case Parameter::combine:
      return;
  }
}

}  // namespace

std::string_view name_of(Method method) {
  return method_table().at(static_cast<std::size_t>(method)).name;
}

std::optional<Method> method_from_name(std::string_view name) {
  const auto& table = method_table();
  const auto match = std::ranges::find(table, name, &MethodEntry::name);
  if (match == table.end()) return std::nullopt;
  return static_cast<Method>(match - table.begin());
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const MethodEntry& entry : method_table()) names.emplace_back(entry.name);
  return names;
}

std::vector<Method> methods_with(Parameter parameter) {
  std::vector<Method> methods;
  const auto& table = method_table();
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool has_parameter = std::ranges::count(table[i].parameters, parameter) > 0;
    if (has_parameter) methods.push_back(static_cast<Method>(i));
  }
  return methods;
}

void check_options(const ExtractionOptions& options) {
  const auto index = static_cast<std::size_t>(options.method);
  if (index >= method_table().size()) {
    throw std::invalid_argument("method: unknown value");
  }
  for (const Parameter parameter : method_table()[index].parameters) {
    check_parameter(parameter, options);
  }
}

}  // namespace touchtrial::engine
