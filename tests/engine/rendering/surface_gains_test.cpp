#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "engine/rendering/surface_model.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

struct Stiffness {
  std::vector<double> lateral_n_per_mm;
  std::vector<double> normal_n_per_mm;
};

/// Stiffness at every interior pixel, from the model's own forces around the height at which the
/// pixel meets a load of 0.7 N.
void append_stiffness(engine::FieldView field, engine::RenderingOptions options,
                      engine::Gains gains, Stiffness& all) {
  options.max_force_n = 1e30;
  const engine::SurfaceModel model(field, options, gains);
  const double pitch_mm = field.geometry.pitch_mm;
  const auto force_n = [&](double x_mm, double y_mm, double z_mm) {
    engine::Bristle bristle;
    return model.force_n({x_mm, y_mm, z_mm}, {}, bristle);
  };
  for (int y = 1; y + 1 < field.geometry.height_px; ++y) {
    for (int x = 1; x + 1 < field.geometry.width_px; ++x) {
      const Vec2 at = field.geometry.to_mm(x, y);
      constexpr double kDeepMm = -1e3;  // all pixels in contact
      const auto deep_n = [&](double x_mm, double y_mm) { return force_n(x_mm, y_mm, kDeepMm).z; };
      const double top_mm = force_n(at.x, at.y, kDeepMm).z / options.stiffness_n_per_mm + kDeepMm;
      const double z_mm = top_mm - engine::kReferenceLoadN / options.stiffness_n_per_mm;
      const Vec3 along = (0.5 / pitch_mm) * (force_n(at.x + pitch_mm, at.y, z_mm) -
                                             force_n(at.x - pitch_mm, at.y, z_mm));
      const Vec3 down = (0.5 / pitch_mm) * (force_n(at.x, at.y + pitch_mm, z_mm) -
                                            force_n(at.x, at.y - pitch_mm, z_mm));
      all.lateral_n_per_mm.push_back(
          std::sqrt(along.x * along.x + along.y * along.y + down.x * down.x + down.y * down.y));
      all.normal_n_per_mm.push_back(
          std::hypot(deep_n(at.x + pitch_mm, at.y) - deep_n(at.x - pitch_mm, at.y),
                     deep_n(at.x, at.y + pitch_mm) - deep_n(at.x, at.y - pitch_mm)) *
          0.5 / pitch_mm);
    }
  }
}

/// The larger of the two pooled percentiles.
double stiffest_p99(const std::vector<engine::TextureField>& fields,
                    const engine::RenderingOptions& options, const engine::StudyGains& gains) {
  Stiffness all;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    append_stiffness(fields[i].view(), options, gains.per_field[i], all);
  }
  return std::max(percentile_slowly(all.lateral_n_per_mm, 0.99),
                  percentile_slowly(all.normal_n_per_mm, 0.99));
}

std::vector<engine::TextureField> three_surfaces() {
  std::vector<engine::TextureField> fields;
  fields.push_back(random_surface(40, 50, 1, 20.0));
  fields.push_back(random_surface(33, 21, 2, 60.0));
  fields.push_back(random_surface(25, 60, 3, 5.0));
  return fields;
}

TEST_CASE("choose_gains gives surfaces the height at which their stiffness meets the budget") {
  const std::vector<engine::TextureField> fields = three_surfaces();
  engine::RenderingOptions options = surface_options();
  options.equalise = GENERATE(engine::Equalise::none, engine::Equalise::rms);
  options.texture_stiffness_n_per_mm = GENERATE(0.01, 0.4, 5.0);
  options.stiffness_n_per_mm = GENERATE(0.4, 3.0);
  const engine::StudyGains gains = engine::choose_gains(views_of(fields), options);
  CHECK(gains.per_field[0].height_mm > 0.0);
  CHECK(gains.per_field[0].tangential_n == 0.0);
  CHECK_FALSE(gains.over_budget);
  CHECK(stiffest_p99(fields, options, gains) ==
        Approx(options.texture_stiffness_n_per_mm).epsilon(1e-5));
}

TEST_CASE("choose_gains gives surfaces the same rms lateral force when they are equalised") {
  const std::vector<engine::TextureField> fields = three_surfaces();
  engine::RenderingOptions options = surface_options();
  options.equalise = engine::Equalise::rms;
  options.gains =
      GENERATE(std::optional<engine::Gains>(), std::optional<engine::Gains>({.height_mm = 0.003}));
  const engine::StudyGains gains = engine::choose_gains(views_of(fields), options);
  std::vector<double> rms_n;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const engine::FieldView view = fields[i].view();
    rms_n.push_back(engine::field_statistics(view, gains.per_field[i], options).tangential_rms_n);
  }
  CHECK(rms_n[0] > 0.0);
  CHECK(rms_n[1] == Approx(rms_n[0]).epsilon(1e-12));
  CHECK(rms_n[2] == Approx(rms_n[0]).epsilon(1e-12));
}

TEST_CASE("choose_gains takes an explicit height and says when it exceeds the budget") {
  const std::vector<engine::TextureField> fields = three_surfaces();
  engine::RenderingOptions options = surface_options();
  const double allowed_mm = engine::choose_gains(views_of(fields), options).per_field[0].height_mm;
  options.gains = engine::Gains{.height_mm = allowed_mm};
  const engine::StudyGains same = engine::choose_gains(views_of(fields), options);
  CHECK(same.per_field == std::vector<engine::Gains>(3, *options.gains));
  CHECK_FALSE(same.over_budget);
  options.gains = engine::Gains{.height_mm = 1.001 * allowed_mm};
  CHECK(engine::choose_gains(views_of(fields), options).over_budget);
}

TEST_CASE("choose_gains leaves flat surfaces without height, and out of the pool") {
  const std::vector<engine::TextureField> flat = {flat_surface(10, 10), flat_surface(1, 7)};
  CHECK(engine::choose_gains(views_of(flat), surface_options()).per_field ==
        std::vector<engine::Gains>(2));
  std::vector<engine::TextureField> both = {random_surface(40, 40, 5)};
  const engine::Gains alone = engine::choose_gains(views_of(both), surface_options()).per_field[0];
  both.push_back(flat_surface(300, 300));
  CHECK(engine::choose_gains(views_of(both), surface_options()).per_field[0] == alone);
  const std::vector<engine::TextureField> thin = {random_surface(2, 50, 6)};
  CHECK(engine::choose_gains(views_of(thin), surface_options()).per_field[0] == engine::Gains{});
}

TEST_CASE("choose_gains uses the maximum where almost all of a surface is a spline's faint tail") {
  engine::RenderingOptions options = surface_options();
  options.filter_mm = 0.0;
  Plane<double> texture(200, 200, 0.0);
  for (int x = 100; x < 110; ++x) texture.at(100, x) = x % 2 == 0 ? 40.0 : -30.0;
  const std::vector<engine::TextureField> fields = {engine::make_texture_field(texture, options)};
  const engine::Gains gains = engine::choose_gains(views_of(fields), options).per_field[0];
  Stiffness all;
  append_stiffness(fields[0].view(), options, gains, all);
  const auto stiffest =
      std::max(std::ranges::max(all.lateral_n_per_mm), std::ranges::max(all.normal_n_per_mm));
  CHECK(percentile_slowly(all.lateral_n_per_mm, 0.99) > 0.0);
  CHECK(stiffest == Approx(0.4).epsilon(1e-4));
}

TEST_CASE("choose_gains bounds surfaces of any amplitude") {
  const double amplitude = GENERATE(1e-12, 1e-3, 1e12);
  const std::vector<engine::TextureField> fields = {random_surface(30, 30, 7, amplitude)};
  const engine::StudyGains gains = engine::choose_gains(views_of(fields), surface_options());
  CHECK(stiffest_p99(fields, surface_options(), gains) == Approx(0.4).epsilon(1e-4));
}

TEST_CASE("choose_gains refuses fields of the other model and coefficients that are not finite") {
  const std::vector<engine::TextureField> fields = three_surfaces();
  CHECK_THROWS_AS(engine::choose_gains(views_of(fields), {}), std::invalid_argument);
  std::vector<float> coefficients(25, 0.0F);
  coefficients[7] = std::numeric_limits<float>::quiet_NaN();
  const engine::FieldView broken{{0.2, 5, 5}, {}, coefficients};
  CHECK_THROWS_AS(engine::choose_gains({&broken, 1}, surface_options()), std::invalid_argument);
  CHECK_THROWS_AS(engine::field_statistics(broken, {}, surface_options()), std::invalid_argument);
}

TEST_CASE("field_statistics of a surface are those of its forces at the stated load") {
  const engine::RenderingOptions options = surface_options();
  const engine::TextureField field = random_surface(40, 50, 8);
  const engine::FieldView view = field.view();
  const engine::Gains gains = engine::choose_gains({&view, 1}, options).per_field[0];
  const engine::FieldStatistics statistics = engine::field_statistics(view, gains, options);
  const engine::SurfaceModel model(view, options, gains);
  double squares = 0.0;
  double normal_squares = 0.0;
  std::vector<double> strengths_n;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 50; ++x) {
      const Vec2 at = view.geometry.to_mm(x, y);
      engine::Bristle bristle;
      const Vec3 force_n = model.force_n({at.x, at.y, -1.75}, {}, bristle);
      // Lateral force is proportional to the load: scaled to 0.7 N.
      strengths_n.push_back(std::hypot(force_n.x, force_n.y) * 0.7 / force_n.z);
      squares += strengths_n.back() * strengths_n.back();
      normal_squares += (force_n.z - 0.7) * (force_n.z - 0.7);
    }
  }
  CHECK(statistics.tangential_rms_n == Approx(std::sqrt(squares / 2000.0)).epsilon(1e-5));
  CHECK(statistics.tangential_p999_n ==
        Approx(percentile_slowly(strengths_n, 0.999)).epsilon(1e-5));
  CHECK(statistics.normal_rms_n == Approx(std::sqrt(normal_squares / 2000.0)).epsilon(1e-4));
  CHECK(statistics.stiffness_p99_n_per_mm == Approx(0.4).epsilon(1e-5));
  CHECK(statistics.share_below_1_mm > 0.0);
}

}  // namespace
}  // namespace touchtrial
