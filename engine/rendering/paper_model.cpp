#include "engine/rendering/paper_model.hpp"

#include "core/parallel.hpp"
#include "engine/force_field.hpp"
#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/model_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

namespace touchtrial::engine {
namespace {

constexpr int kMaxReach = kMaxNeighbourhood / 2;

/// dx / (dx^2 + dy^2) at [dy][dx].
constexpr auto kPull = [] {
  std::array<std::array<double, kMaxReach + 1>, kMaxReach + 1> pull{};
  for (int dy = 0; dy <= kMaxReach; ++dy) {
    for (int dx = 1; dx <= kMaxReach; ++dx) {
      pull[dy][dx] = double{1} * dx / (dx * dx + dy * dy);
    }
  }
  return pull;
}();

/// The tangential force at a pixel's centre, computed by its definition (docs/method.md, "Force
/// field").
Vec2 force_at_pixel(const FieldView& field, int y, int x) noexcept {
  const float* const heights = field.slopes().data();
  const int width = field.geometry.width_px;
  const int reach = std::min(field.neighbourhood / 2, kMaxReach);
  const auto row = [&](int index) { return heights + static_cast<std::size_t>(index) * width; };
  const double centre = row(y)[x];
  Vec2 force;
  for (int dy = -std::min(reach, y); dy <= std::min(reach, field.geometry.height_px - 1 - y);
       ++dy) {
    const float* const neighbours = row(y + dy) + x;
    for (int dx = -std::min(reach, x); dx <= std::min(reach, width - 1 - x); ++dx) {
      const double difference = centre - neighbours[dx];
      force.x += difference * std::copysign(kPull[std::abs(dy)][std::abs(dx)], dx);
      force.y += difference * std::copysign(kPull[std::abs(dx)][std::abs(dy)], dy);
    }
  }
  return force;
}

/// The same force for a neighbourhood of 3, without branches. Missing neighbours have weight 0 and
/// the position of an existing one.
Vec2 force_in_3x3(const float* heights, const PlaneGeometry& plane, int y, int x) noexcept {
  const int left = x > 0 ? 1 : 0;
  const int right = x + 1 < plane.width_px ? 1 : 0;
  const int up = y > 0 ? 1 : 0;
  const int down = y + 1 < plane.height_px ? 1 : 0;
  const float* const middle = heights + static_cast<std::size_t>(y) * plane.width_px + x;
  const float* const above = middle - std::ptrdiff_t{up} * plane.width_px;
  const float* const below = middle + std::ptrdiff_t{down} * plane.width_px;
  const double centre = *middle;
  /// left * (G_left - G_i) - right * (G_right - G_i) in a row.
  const auto row_force = [&](const float* row) {
    return left * (row[-left] - centre) - right * (row[right] - centre);
  };
  const auto column_force = [&](int dx) {
    return up * (above[dx] - centre) - down * (below[dx] - centre);
  };
  return {row_force(middle) + 0.5 * (up * row_force(above) + down * row_force(below)),
          column_force(0) + 0.5 * (left * column_force(-left) + right * column_force(right))};
}

/// A point between pixels: from column `left` towards `left + right` (`right` is 0 or 1) by the
/// fraction `to_right`; likewise along y.
struct PixelPosition {
  int left;
  int top;
  int right;
  int down;
  double to_right;
  double to_down;
};

PixelPosition pixel_position(const PlaneGeometry& plane, Vec2 px) noexcept {
  const double x = std::clamp(px.x, 0.0, plane.width_px - 1.0);
  const double y = std::clamp(px.y, 0.0, plane.height_px - 1.0);
  const auto left = static_cast<int>(x);
  const auto top = static_cast<int>(y);
  return {left,     top,    left + 1 < plane.width_px ? 1 : 0, top + 1 < plane.height_px ? 1 : 0,
          x - left, y - top};
}

/// Interpolates value_at(y, x) bilinearly between the four pixels.
template <typename ValueAt>
auto interpolate(const PixelPosition& pixel, ValueAt value_at) noexcept {
  const auto along_row = [&](int y) {
    const auto left = value_at(y, pixel.left);
    if (pixel.to_right == 0.0) return left;  // as in the outer half pixel
    return left + pixel.to_right * (value_at(y, pixel.left + pixel.right) - left);
  };
  const auto upper = along_row(pixel.top);
  if (pixel.to_down == 0.0) return upper;
  return upper + pixel.to_down * (along_row(pixel.top + pixel.down) - upper);
}

double height_at(const FieldView& field, const PixelPosition& pixel) noexcept {
  return interpolate(pixel, [&](int y, int x) {
    return double{field.heights[static_cast<std::size_t>(y) * field.geometry.width_px + x]};
  });
}

/// Height and force at any point, interpolated between the four pixels around it.
[[gnu::noinline]] PatchSums general_sums(const FieldView& field, Vec2 px) noexcept {
  const PixelPosition pixel = pixel_position(field.geometry, px);
  const bool is_default = field.neighbourhood == 3;
  const Vec2 force = interpolate(pixel, [&](int y, int x) {
    return is_default ? force_in_3x3(field.slopes().data(), field.geometry, y, x)
                      : force_at_pixel(field, y, x);
  });
  return {height_at(field, pixel), force.x, force.y};
}

/// The patches for the tangential force; none unless the neighbourhood is 3.
Patches patches_of(const FieldView& field) {
  if (field.empty() || field.neighbourhood != 3) return {};
  return {field.slopes(), field.geometry.height_px, field.geometry.width_px, bilinear_sum()};
}

/// Replaces a field of another model by a flat wall.
FieldView paper_field_or_wall(FieldView field) noexcept {
  if (field.model != ModelKind::paper) field.heights = {};
  return field;
}

constexpr double kBudgetTolerance = 1e-9;  // relative

TextureField make_paper_field(Plane<double> smooth, const RenderingOptions& options) {
  if (options.neighbourhood < 3 || options.neighbourhood % 2 == 0 ||
      options.neighbourhood > kMaxNeighbourhood) {
    throw std::invalid_argument("make_texture_field: the neighbourhood must be odd, 3 to 31");
  }
  return TextureField({.geometry = {options.pitch_mm, smooth.height(), smooth.width()},
                       .model = ModelKind::paper,
                       .neighbourhood = options.neighbourhood},
                      converted<float>(smooth));
}

Plane<double> plane_of(std::span<const float> samples, const PlaneGeometry& geometry) {
  Plane<double> plane(geometry.height_px, geometry.width_px);
  std::ranges::copy(samples, plane.samples().begin());
  return plane;
}

/// Vectorised form of force_at_pixel() with a neighbourhood of 3, equal to the last bit, for pixels
/// 1 .. width - 2 of an interior row.
/// \param middle  the row's first height
void force_row(const float* middle, int width, float* force_x, float* force_y) noexcept {
  const float* const above = middle - width;
  const float* const below = middle + width;
  for (int x = 1; x < width - 1; ++x) {
    const double centre = middle[x];
    const double nw = 0.5 * (centre - above[x - 1]);
    const double ne = 0.5 * (centre - above[x + 1]);
    const double sw = 0.5 * (centre - below[x - 1]);
    const double se = 0.5 * (centre - below[x + 1]);
    force_x[x] =
        static_cast<float>(ne - nw - (centre - middle[x - 1]) + (centre - middle[x + 1]) - sw + se);
    force_y[x] = static_cast<float>(-nw - (centre - above[x]) - ne + sw + (centre - below[x]) + se);
  }
}

/// Samples a field with a neighbourhood of 3, without planes in double.
SampledField sample_paper_3x3(FieldView field) {
  const int height = field.geometry.height_px;
  const int width = field.geometry.width_px;
  SampledField sampled{field.geometry, {height, width}};
  for_each_strip(height, width, [&](Rows strip) {
    std::vector<float> force_x(static_cast<std::size_t>(width));
    std::vector<float> force_y(force_x.size());
    for (int y = strip.first; y < strip.last; ++y) {
      const std::size_t begin = static_cast<std::size_t>(y) * width;
      const bool is_inside = y > 0 && y + 1 < height;
      if (is_inside)
        force_row(field.slopes().data() + begin, width, force_x.data(), force_y.data());
      for (int x = 0; x < width; x += is_inside && x == 0 && width > 1 ? width - 1 : 1) {
        const Vec2 force = force_at_pixel(field, y, x);
        force_x[x] = static_cast<float>(force.x);
        force_y[x] = static_cast<float>(force.y);
      }
      const std::span<FieldSample> samples = sampled.samples.row(y);
      for (int x = 0; x < width; ++x) {
        samples[x] = {field.heights[begin + x], force_x[x], force_y[x]};
      }
    }
  });
  return sampled;
}

SampledField sample_paper(FieldView field) {
  if (field.neighbourhood == 3) return sample_paper_3x3(field);
  const ForceField<double> force =
      tangential_force(plane_of(field.slopes(), field.geometry), field.neighbourhood);
  SampledField sampled{field.geometry, {field.geometry.height_px, field.geometry.width_px}};
  for (std::size_t i = 0; i < field.heights.size(); ++i) {
    sampled.samples.samples()[i] = {field.heights[i], static_cast<float>(force.x.samples()[i]),
                                    static_cast<float>(force.y.samples()[i])};
  }
  return sampled;
}

/// The inputs of one gain, k_t or c: one entry per field.
struct Channel {
  std::vector<double> rms;
  std::vector<double> factors;                ///< equalising_factors()
  std::vector<std::vector<float>> stiffness;  ///< with the factors; empty for a flat field

  explicit Channel(std::size_t fields) : rms(fields), factors(fields), stiffness(fields) {}
};

/// The ramp's slopes, with a minimum length that keeps them finite.
RampSlopes ramp_slopes(const RenderingOptions& options, double normal_n) {
  constexpr double kMinRampN = 1e-9;
  if (options.touchdown_ramp_n == 0.0) return {};
  const double ramp_n = std::max(options.touchdown_ramp_n, kMinRampN);
  return {normal_n / ramp_n, options.stiffness_n_per_mm / ramp_n};
}

struct ChannelGains {
  std::vector<double> per_field;
  bool over_budget = false;
};

ChannelGains channel_gains(const Channel& channel, std::optional<double> explicit_gain,
                           const RenderingOptions& options) {
  ChannelGains gains{channel.factors};
  const double stiffness = typical_stiffness(channel.stiffness);
  const double budget = options.texture_stiffness_n_per_mm;
  double factor = stiffness > 0.0 ? budget / stiffness : 0.0;
  if (explicit_gain) {
    factor = explicit_factor(*explicit_gain, channel.rms, options.equalise);
    gains.over_budget = factor * stiffness > budget * (1.0 + kBudgetTolerance);
  }
  for (double& gain : gains.per_field) gain *= factor;
  return gains;
}

StudyGains choose_paper_gains(std::span<const FieldView> fields, const RenderingOptions& options) {
  Channel tangential_channel(fields.size());
  Channel normal_channel(fields.size());
  const auto set_rms = [&](Channel& channel, std::size_t i, double rms) {
    channel.rms[i] = rms;
    channel.factors[i] = equalising_factors({&rms, 1}, options.equalise).front();
  };
  in_parallel(jobs_for(fields), fields.size(), [&](std::size_t i) {
    const SampledField sampled = sample_paper(fields[i]);
    set_rms(tangential_channel, i, tangential_rms(sampled.view()));
    set_rms(normal_channel, i, height_rms(sampled.view()));
    if (normal_channel.rms[i] > 0.0)
      normal_channel.stiffness[i] = height_stiffness(sampled.view(), normal_channel.factors[i]);
    if (tangential_channel.rms[i] > 0.0 && options.touchdown_ramp_n == 0.0)
      tangential_channel.stiffness[i] =
          tangential_stiffness(sampled.view(), tangential_channel.factors[i]);
  });
  const std::optional<Gains> explicit_gains = options.gains;
  const ChannelGains normal = channel_gains(
      normal_channel, explicit_gains ? std::optional(explicit_gains->normal_n) : std::nullopt,
      options);
  // On a ramp, heights scaled by the normal gain add to the lateral stiffness.
  if (options.touchdown_ramp_n != 0.0) {
    in_parallel(jobs_for(fields), fields.size(), [&](std::size_t i) {
      if (tangential_channel.rms[i] == 0.0) return;
      tangential_channel.stiffness[i] =
          tangential_stiffness(sample_paper(fields[i]).view(), tangential_channel.factors[i],
                               ramp_slopes(options, normal.per_field[i]));
    });
  }
  const ChannelGains tangential = channel_gains(
      tangential_channel,
      explicit_gains ? std::optional(explicit_gains->tangential_n) : std::nullopt, options);
  StudyGains gains;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    gains.per_field.push_back({tangential.per_field[i], normal.per_field[i]});
  }
  gains.over_budget = tangential.over_budget || normal.over_budget;
  return gains;
}

FieldStatistics paper_statistics(FieldView field, Gains gains, const RenderingOptions& options) {
  const SampledField sampled = sample_paper(field);
  const SampledView view = sampled.view();
  const double heights = height_rms(view);
  require_finite_rms(tangential_rms(view), heights);
  FieldStatistics statistics = lateral_statistics(view, gains.tangential_n);
  statistics.normal_rms_n = gains.normal_n * heights;
  const std::vector<float> stiffness =
      tangential_stiffness(view, 1.0, ramp_slopes(options, gains.normal_n));
  statistics.stiffness_p99_n_per_mm = gains.tangential_n * percentile({&stiffness, 1}, 0.99);
  return statistics;
}

double paper_n_per_grey(FieldView /*field*/, Gains gains) noexcept {
  return gains.tangential_n;
}

}  // namespace

PaperModel::PaperModel(FieldView field, const RenderingOptions& options, Gains gains)
    : field_(paper_field_or_wall(field)),
      patches_(patches_of(field_)),
      stiffness_n_per_mm_(options.stiffness_n_per_mm),
      damping_n_s_per_mm_(options.damping_n_s_per_mm),
      reference_height_(options.reference_grey - kMidGrey),
      touchdown_ramp_n_(options.touchdown_ramp_n),
      max_force_n_(options.max_force_n),
      gains_(gains) {}

Vec3 PaperModel::force_n(const Vec3& position, const Vec3& velocity_mm_s) const noexcept {
  const Vec3 position_mm = copy_by_component(position);
  if (!is_finite(position_mm) || !is_finite(velocity_mm_s)) return {};
  double elastic_n = -stiffness_n_per_mm_ * position_mm.z;
  PatchSums texture;
  const Vec2 px = field_.geometry.to_px(position_mm.x, position_mm.y);
  const bool is_default = patches_.has(px);
  if (is_default || (field_.geometry.contains(position_mm.x, position_mm.y) && !field_.empty())) {
    if (is_out_of_reach(elastic_n)) return {};
    texture = is_default ? patches_.at(px) : general_sums(field_, px);
    if (is_default && !field_.slope_heights.empty()) {
      texture.value = height_at(field_, pixel_position(field_.geometry, px));
    }
    elastic_n += gains_.normal_n * (texture.value - reference_height_);
  }
  const double normal_n = elastic_n - damping_n_s_per_mm_ * velocity_mm_s.z;
  const double load_n = std::min(normal_n, elastic_n);  // NaN if F_N is
  if (!(load_n > 0.0)) return {};
  double tangential_n = gains_.tangential_n;
  if (load_n < touchdown_ramp_n_) tangential_n *= load_n / touchdown_ramp_n_;
  return limit_norm({tangential_n * texture.along_x, tangential_n * texture.along_y, normal_n},
                    max_force_n_);
}

bool PaperModel::is_out_of_reach(double wall_n) const noexcept {
  if (reference_height_ == -kMidGrey && wall_n <= 0.0) return true;
  return wall_n + gains_.normal_n * (field_.highest - reference_height_) <= 0.0;
}

ModelParts paper_parts() noexcept {
  return {make_paper_field, sample_paper, choose_paper_gains, paper_statistics, paper_n_per_grey};
}

}  // namespace touchtrial::engine
