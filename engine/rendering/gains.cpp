#include "engine/rendering/gains.hpp"

#include "engine/rendering/model_parts.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

void check(std::span<const FieldView> fields, const RenderingOptions& options) {
  if (fields.empty()) throw std::invalid_argument("choose_gains: there is no field");
  const double budget = options.texture_stiffness_n_per_mm;
  if (!std::isfinite(budget) || budget <= 0.0) {
    throw std::invalid_argument("choose_gains: the budget must be a finite number > 0");
  }
  if (options.gains && !are_valid(*options.gains)) {
    throw std::invalid_argument("choose_gains: explicit gains must be finite numbers >= 0");
  }
  if (!std::ranges::all_of(fields,
                           [&](const FieldView& field) { return field.model == options.model; })) {
    throw std::invalid_argument("choose_gains: a field has another rendering model");
  }
}

}  // namespace

StudyGains choose_gains(std::span<const FieldView> fields, const RenderingOptions& options) {
  check(fields, options);
  return parts_of(options.model).choose_gains(fields, options);
}

}  // namespace touchtrial::engine
