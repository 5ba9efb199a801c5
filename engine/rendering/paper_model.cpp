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

/// The tangential force at a pixel's centre, from the definition (docs/method.md, "Force field").
Vec2 force_at_pixel(const FieldView& field, int y, int x) noexcept {
  const float* const heights = field.slopes().data();
  const int width = field.geometry.width_px;
  const int reach = std::min(field.neighbourhood / 2, kMaxReach);
  const auto row = [&](int at) { return heights + static_cast<std::size_t>(at) * width; };
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

/// The same for a neighbourhood of 3, without branches. Missing neighbours are replaced by existing
/// ones with weight 0.
Vec2 force_at_any_pixel(const float* heights, const PlaneGeometry& plane, int y, int x) noexcept {
  const int left = x > 0 ? 1 : 0;
  const int right = x + 1 < plane.width_px ? 1 : 0;
  const int up = y > 0 ? 1 : 0;
  const int down = y + 1 < plane.height_px ? 1 : 0;
  const float* const middle = heights + static_cast<std::size_t>(y) * plane.width_px + x;
  const float* const above = middle - std::ptrdiff_t{up} * plane.width_px;
  const float* const below = middle + std::ptrdiff_t{down} * plane.width_px;
  const double centre = *middle;
  /// left * (G_left - G_i) - right * (G_right - G_i) in a row.
  const auto across = [&](const float* row) {
    return left * (row[-left] - centre) - right * (row[right] - centre);
  };
  const auto along = [&](int dx) {
    return up * (above[dx] - centre) - down * (below[dx] - centre);
  };
  return {across(middle) + 0.5 * (up * across(above) + down * across(below)),
          along(0) + 0.5 * (left * along(-left) + right * along(right))};
}

/// A point among pixels: between `left` and `left + right` (0 or 1) by the share `to_right`, and
/// likewise along y.
struct Place {
  int left;
  int top;
  int right;
  int down;
  double to_right;
  double to_down;
};

Place place_in(const PlaneGeometry& plane, Vec2 px) noexcept {
  const double x = std::clamp(px.x, 0.0, plane.width_px - 1.0);
  const double y = std::clamp(px.y, 0.0, plane.height_px - 1.0);
  const auto left = static_cast<int>(x);
  const auto top = static_cast<int>(y);
  return {left,     top,    left + 1 < plane.width_px ? 1 : 0, top + 1 < plane.height_px ? 1 : 0,
          x - left, y - top};
}

/// Bilinear between the four pixels, given the value at (y, x) of each.
template <typename ValueAt>
auto mixed(const Place& at, ValueAt value_at) noexcept {
  const auto along_row = [&](int y) {
    const auto left = value_at(y, at.left);
    if (at.to_right == 0.0) return left;  // as in the outer half pixel
    return left + at.to_right * (value_at(y, at.left + at.right) - left);
  };
  const auto upper = along_row(at.top);
  if (at.to_down == 0.0) return upper;
  return upper + at.to_down * (along_row(at.top + at.down) - upper);
}

double height_at(const FieldView& field, const Place& at) noexcept {
  return mixed(at, [&](int y, int x) {
    return double{field.heights[static_cast<std::size_t>(y) * field.geometry.width_px + x]};
  });
}

/// Height and force at any point, from the definition at the four pixels round it.
[[gnu::noinline]] PatchSums sums_anywhere(const FieldView& field, Vec2 px) noexcept {
  const Place at = place_in(field.geometry, px);
  const bool is_default = field.neighbourhood == 3;
  const Vec2 force = mixed(at, [&](int y, int x) {
    return is_default ? force_at_any_pixel(field.slopes().data(), field.geometry, y, x)
                      : force_at_pixel(field, y, x);
  });
  return {height_at(field, at), force.x, force.y};
}

/// The patches of the plane whose slopes are felt, for the usual neighbourhood.
Patches patches_of(const FieldView& field) {
  if (field.empty() || field.neighbourhood != 3) return {};
  return {field.slopes(), field.geometry.height_px, field.geometry.width_px, bilinear_sum()};
}

/// The field, or the flat wall if it is of another model.
FieldView of_paper(FieldView field) noexcept {
  if (field.model != ModelKind::paper) field.heights = {};
  return field;
}

constexpr double kSlackOfGains = 1e-9;  // relative; less above the budget is rounding

TextureField field_of_paper(Plane<double> smooth, const RenderingOptions& options) {
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

/// The same as force_at_pixel with a neighbourhood of 3, to the last bit, for the pixels 1 ..
/// width - 2 of a row that has rows above and below. Its loop vectorises.
/// \param middle  the row's first height
void row_of_forces(const float* middle, int width, float* force_x, float* force_y) noexcept {
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

/// With a neighbourhood of 3, without planes in double.
SampledField sampled_by_rows(FieldView field) {
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
        row_of_forces(field.slopes().data() + begin, width, force_x.data(), force_y.data());
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

SampledField sampled_paper(FieldView field) {
  if (field.neighbourhood == 3) return sampled_by_rows(field);
  const ForceField<double> force =
      tangential_force(plane_of(field.slopes(), field.geometry), field.neighbourhood);
  SampledField sampled{field.geometry, {field.geometry.height_px, field.geometry.width_px}};
  for (std::size_t i = 0; i < field.heights.size(); ++i) {
    sampled.samples.samples()[i] = {field.heights[i], static_cast<float>(force.x.samples()[i]),
                                    static_cast<float>(force.y.samples()[i])};
  }
  return sampled;
}

/// The inputs of one of the two gains, k_t or c. One entry for each field.
struct Channel {
  std::vector<double> rms;
  std::vector<double> factors;                ///< equalising
  std::vector<std::vector<float>> stiffness;  ///< with the factors; empty for a flat field

  explicit Channel(std::size_t fields) : rms(fields), factors(fields), stiffness(fields) {}
};

/// How the ramp adds to the lateral force's stiffness. Ramps too short to be distinguished from a
/// step count as this long, which keeps the numbers finite.
RampSlopes ramp_slopes(const RenderingOptions& options, double normal_n) {
  constexpr double kMinRampN = 1e-9;
  if (options.touchdown_ramp_n == 0.0) return {};
  const double ramp_n = std::max(options.touchdown_ramp_n, kMinRampN);
  return {normal_n / ramp_n, options.stiffness_n_per_mm / ramp_n};
}

struct ChannelGains {
  std::vector<double> of_field;
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
    gains.over_budget = factor * stiffness > budget * (1.0 + kSlackOfGains);
  }
  for (double& gain : gains.of_field) gain *= factor;
  return gains;
}

StudyGains gains_of_paper(std::span<const FieldView> fields, const RenderingOptions& options) {
  Channel along(fields.size());
  Channel across(fields.size());
  const auto set_rms = [&](Channel& channel, std::size_t i, double rms) {
    channel.rms[i] = rms;
    channel.factors[i] = equalising_factors({&rms, 1}, options.equalise).front();
  };
  in_parallel(jobs_for(fields), fields.size(), [&](std::size_t i) {
    const SampledField sampled = sampled_paper(fields[i]);
    set_rms(along, i, tangential_rms(sampled.view()));
    set_rms(across, i, height_rms(sampled.view()));
    if (across.rms[i] > 0.0)
      across.stiffness[i] = height_stiffness(sampled.view(), across.factors[i]);
    if (along.rms[i] > 0.0 && options.touchdown_ramp_n == 0.0)
      along.stiffness[i] = tangential_stiffness(sampled.view(), along.factors[i]);
  });
  std::optional<Gains> given = options.gains;
  const ChannelGains normal =
      channel_gains(across, given ? std::optional(given->normal_n) : std::nullopt, options);
  // On a ramp, heights add to the lateral stiffness with the gain chosen before.
  if (options.touchdown_ramp_n != 0.0) {
    in_parallel(jobs_for(fields), fields.size(), [&](std::size_t i) {
      if (along.rms[i] == 0.0) return;
      along.stiffness[i] = tangential_stiffness(sampled_paper(fields[i]).view(), along.factors[i],
                                                ramp_slopes(options, normal.of_field[i]));
    });
  }
  const ChannelGains tangential =
      channel_gains(along, given ? std::optional(given->tangential_n) : std::nullopt, options);
  StudyGains gains;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    gains.of_field.push_back({tangential.of_field[i], normal.of_field[i]});
  }
  gains.over_budget = tangential.over_budget || normal.over_budget;
  return gains;
}

FieldStatistics statistics_of_paper(FieldView field, Gains gains, const RenderingOptions& options) {
  const SampledField sampled = sampled_paper(field);
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

double n_per_grey_of_paper(FieldView /*field*/, Gains gains) noexcept {
  return gains.tangential_n;
}

}  // namespace

PaperModel::PaperModel(FieldView field, const RenderingOptions& options, Gains gains)
    : field_(of_paper(field)),
      patches_(patches_of(field_)),
      stiffness_n_per_mm_(options.stiffness_n_per_mm),
      damping_n_s_per_mm_(options.damping_n_s_per_mm),
      reference_height_(options.reference_grey - kMidGrey),
      touchdown_ramp_n_(options.touchdown_ramp_n),
      max_force_n_(options.max_force_n),
      gains_(gains) {}

Vec3 PaperModel::force_n(const Vec3& position, const Vec3& velocity_mm_s) const noexcept {
  const Vec3 position_mm = by_number(position);
  if (!is_finite(position_mm) || !is_finite(velocity_mm_s)) return {};
  double elastic_n = -stiffness_n_per_mm_ * position_mm.z;
  PatchSums texture;
  const Vec2 px = field_.geometry.to_px(position_mm.x, position_mm.y);
  const bool is_default = patches_.has(px);
  if (is_default || (field_.geometry.contains(position_mm.x, position_mm.y) && !field_.empty())) {
    if (is_out_of_reach(elastic_n)) return {};
    texture = is_default ? patches_.at(px) : sums_anywhere(field_, px);
    if (is_default && !field_.other_slopes.empty()) {
      texture.value = height_at(field_, place_in(field_.geometry, px));
    }
    elastic_n += gains_.normal_n * (texture.value - reference_height_);
  }
  const double normal_n = elastic_n - damping_n_s_per_mm_ * velocity_mm_s.z;
  const double load_n = std::min(normal_n, elastic_n);  // NaN if F_N is
  if (!(load_n > 0.0)) return {};
  double tangential_n = gains_.tangential_n;
  if (load_n < touchdown_ramp_n_) tangential_n *= load_n / touchdown_ramp_n_;
  return limited_in_norm({tangential_n * texture.along_x, tangential_n * texture.along_y, normal_n},
                         max_force_n_);
}

bool PaperModel::is_out_of_reach(double wall_n) const noexcept {
  if (reference_height_ == -kMidGrey && wall_n <= 0.0) return true;
  return wall_n + gains_.normal_n * (field_.highest - reference_height_) <= 0.0;
}

// What make_texture_field, choose_gains, field_statistics and lateral_field do for this model.

ModelParts paper_parts() noexcept {
  return {field_of_paper, sampled_paper, gains_of_paper, statistics_of_paper, n_per_grey_of_paper};
}

}  // namespace touchtrial::engine
