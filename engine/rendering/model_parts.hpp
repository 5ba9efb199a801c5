/// \file The functions of a rendering model besides its force law, which implement
/// make_texture_field(), choose_gains(), field_statistics() and lateral_field(). Private to
/// engine/rendering. How to add a model: docs/add-a-rendering-model.md.
#pragma once

#include "core/plane.hpp"
#include "core/vec.hpp"
#include "engine/kernels/strips.hpp"
#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/texture_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace touchtrial::engine {

/// The functions of one model. Callers check the arguments, except for non-finite samples, for
/// which these functions throw std::invalid_argument.
struct ModelParts {
  /// \param smooth  the texture T after the reconstruction filter, grey levels
  TextureField (*make_field)(Plane<double> smooth, const RenderingOptions& options);
  /// Samples the field at its pixel centres.
  SampledField (*sampled)(FieldView field);
  StudyGains (*choose_gains)(std::span<const FieldView> fields, const RenderingOptions& options);
  FieldStatistics (*statistics)(FieldView field, Gains gains, const RenderingOptions& options);
  /// Newtons of lateral force per (grey level per pixel).
  double (*n_per_grey)(FieldView field, Gains gains) noexcept;
};

[[nodiscard]] ModelParts parts_of(ModelKind kind) noexcept;

/// Defined in paper_model.cpp.
[[nodiscard]] ModelParts paper_parts() noexcept;
/// Defined in surface_model.cpp.
[[nodiscard]] ModelParts surface_parts() noexcept;

/// The statistics of a field's lateral force; leaves the other statistics at 0.
/// \param field  not empty
/// \param n_per_grey  newtons per (grey level per pixel)
[[nodiscard]] FieldStatistics lateral_statistics(SampledView field, double n_per_grey);

/// The `jobs` argument of in_parallel() for measuring fields: all cores, or 1 for large fields, to
/// limit memory, because measuring a large field uses all cores.
[[nodiscard]] inline int jobs_for(std::span<const FieldView> fields) noexcept {
  const auto is_large = [](const FieldView& field) {
    return static_cast<std::int64_t>(field.heights.size()) >= kMinParallelPixels;
  };
  return std::ranges::any_of(fields, is_large) ? 1 : 0;
}

/// Checks a field by its two rms values.
/// \throws std::invalid_argument if one is not finite
void require_finite_rms(double tangential, double normal);

/// Limits the norm of a force and keeps its direction. Handles forces whose squares overflow; a
/// force that is not finite becomes zero.
[[nodiscard]] inline Vec3 limit_norm(Vec3 force_n, double limit_n) noexcept {
  const double squares = force_n.x * force_n.x + force_n.y * force_n.y + force_n.z * force_n.z;
  if (squares <= limit_n * limit_n) return force_n;
  if (!is_finite(force_n)) return {};
  const double largest = std::max({std::abs(force_n.x), std::abs(force_n.y), std::abs(force_n.z)});
  const Vec3 direction = (1.0 / largest) * force_n;
  return (limit_n / norm(direction)) * direction;
}

}  // namespace touchtrial::engine
