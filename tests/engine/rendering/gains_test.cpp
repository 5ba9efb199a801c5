#include "engine/rendering/gains.hpp"

#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace touchtrial {
namespace {

using namespace engine;

/// The stiffness of every interior pixel, from the definition: a finite difference of each
/// component of a vector field in each direction.
std::vector<double> stiffness_slowly(FieldView field, std::vector<float FieldSample::*> components,
                                     double gain) {
  const int height = field.geometry.height_px;
  const int width = field.geometry.width_px;
  const SampledField samples = sampled(field);
  const auto at = [&](int y, int x) -> const FieldSample& { return samples.samples.at(y, x); };
  std::vector<double> norms;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      double squares = 0.0;
      for (const auto component : components) {
        const double along_x = gain * (double{at(y, x + 1).*component} - at(y, x - 1).*component);
        const double along_y = gain * (double{at(y + 1, x).*component} - at(y - 1, x).*component);
        squares += std::pow(along_x / (2.0 * field.geometry.pitch_mm), 2) +
                   std::pow(along_y / (2.0 * field.geometry.pitch_mm), 2);
      }
      norms.push_back(std::sqrt(squares));
    }
  }
  return norms;
}

/// The norm of the lateral force's Jacobian along the plane and in depth at every interior pixel,
/// at the load on the touchdown ramp, or beyond it, at which it is largest.
std::vector<double> stiffness_with_ramp_slowly(FieldView field, const RenderingOptions& options,
                                               Gains gains) {
  const SampledField samples = sampled(field);
  const double two_px_mm = 2.0 * field.geometry.pitch_mm;
  const double ramp_n = options.touchdown_ramp_n;
  std::vector<double> norms;
  for (int y = 1; y + 1 < field.geometry.height_px; ++y) {
    for (int x = 1; x + 1 < field.geometry.width_px; ++x) {
      const auto value = [&](float FieldSample::*of, int dy, int dx) {
        return double{samples.samples.at(y + dy, x + dx).*of};
      };
      double largest = 0.0;
      for (int tenths = 0; tenths <= 11; ++tenths) {
        const bool is_beyond = tenths > 10;
        const double share = is_beyond ? 1.0 : 0.1 * tenths;
        double squares = 0.0;
        for (const auto of : {&FieldSample::force_x, &FieldSample::force_y}) {
          const double force_n = gains.tangential_n * value(of, 0, 0);
          for (const auto& [dy, dx] : {std::pair{0, 1}, {1, 0}}) {
            const double change =
                gains.tangential_n * (value(of, dy, dx) - value(of, -dy, -dx)) / two_px_mm;
            const double load =
                gains.normal_n *
                (value(&FieldSample::height, dy, dx) - value(&FieldSample::height, -dy, -dx)) /
                two_px_mm;
            squares += std::pow(share * change + (is_beyond ? 0.0 : force_n * load / ramp_n), 2);
          }
          if (!is_beyond) squares += std::pow(force_n * options.stiffness_n_per_mm / ramp_n, 2);
        }
        largest = std::max(largest, std::sqrt(squares));
      }
      norms.push_back(largest);
    }
  }
  return norms;
}

struct Stiffness {
  double tangential_n_per_mm;
  double normal_n_per_mm;
};

Stiffness pooled_p99(const std::vector<TextureField>& fields, const StudyGains& gains) {
  std::vector<double> tangential;
  std::vector<double> normal;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const FieldView view = fields[i].view();
    const Gains gain = gains.per_field[i];
    const auto along =
        stiffness_slowly(view, {&FieldSample::force_x, &FieldSample::force_y}, gain.tangential_n);
    const auto across = stiffness_slowly(view, {&FieldSample::height}, gain.normal_n);
    tangential.insert(tangential.end(), along.begin(), along.end());
    normal.insert(normal.end(), across.begin(), across.end());
  }
  return {percentile_slowly(tangential, 0.99), percentile_slowly(normal, 0.99)};
}

std::vector<TextureField> three_fields() {
  std::vector<TextureField> fields;
  fields.push_back(random_field(40, 50, 1, 20.0));
  fields.push_back(random_field(33, 21, 2, 60.0));
  fields.push_back(random_field(25, 60, 3, 5.0));
  return fields;
}

RenderingOptions equalised() {
  return {.equalise = Equalise::rms};
}

/// A field from a function of the pixel, without filter.
template <typename Texture>
TextureField unfiltered(int height, int width, Texture texture) {
  Plane<double> plane(height, width);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) plane.at(y, x) = texture(y, x);
  }
  RenderingOptions options{.filter_mm = 0.0};
  return engine::make_texture_field(plane, options);
}

double percentile_of(const std::vector<float>& pool, double share) {
  return engine::percentile({&pool, 1}, share);
}

TEST_CASE("percentile of several pools is that of all their values, sorted") {
  RandomStream random(3, "pools");
  const int scale = GENERATE(1, 40);  // many equal values, or few
  std::vector<std::vector<float>> pools(3);
  std::vector<double> all;
  for (int i = 0; i < 5000; ++i) {
    const double value = std::floor(scale * random.uniform(0.0, 1.0)) * std::exp(random.normal());
    pools[static_cast<std::size_t>(i) % 3].push_back(static_cast<float>(value));
    all.push_back(pools[static_cast<std::size_t>(i) % 3].back());
  }
  pools.emplace_back();
  const double share = GENERATE(0.0, 0.1, 0.5, 0.9, 0.99, 0.9991, 1.0);
  CHECK(engine::percentile(pools, share) == Approx(percentile_slowly(all, share)).epsilon(1e-12));
}

TEST_CASE("percentile interpolates linearly between order statistics") {
  std::vector<float> hundred;
  for (int i = 100; i >= 0; --i) hundred.push_back(static_cast<float>(i));
  CHECK(percentile_of(hundred, 0.99) == 99.0);
  CHECK(percentile_of(hundred, 0.0) == 0.0);
  CHECK(percentile_of(hundred, 1.0) == 100.0);
  std::vector<float> four = {40.0F, 10.0F, 30.0F, 20.0F};
  CHECK(percentile_of(four, 0.5) == 25.0);
  CHECK(percentile_of(four, 0.99) == Approx(39.7).epsilon(1e-12));
  std::vector<float> one = {7.0F};
  CHECK(percentile_of(one, 0.99) == 7.0);
  std::vector<float> none;
  CHECK(percentile_of(none, 0.99) == 0.0);
}

TEST_CASE("choose_gains meets the stiffness budget exactly over all fields together") {
  const std::vector<TextureField> fields = three_fields();
  RenderingOptions options = GENERATE(RenderingOptions{}, equalised());
  options.texture_stiffness_n_per_mm = GENERATE(0.1, 0.4, 2.0);
  const StudyGains gains = engine::choose_gains(views_of(fields), options);
  const Stiffness stiffness = pooled_p99(fields, gains);
  const double budget = options.texture_stiffness_n_per_mm;
  CHECK(stiffness.tangential_n_per_mm == Approx(budget).epsilon(1e-6));
  CHECK(stiffness.normal_n_per_mm == Approx(budget).epsilon(1e-6));
  CHECK_FALSE(gains.over_budget);
}

TEST_CASE("choose_gains meets the budget with a touchdown ramp, whose stiffness counts") {
  const std::vector<TextureField> fields = three_fields();
  RenderingOptions options = GENERATE(RenderingOptions{}, equalised());
  const Gains without = engine::choose_gains(views_of(fields), options).per_field[0];
  options.touchdown_ramp_n = GENERATE(0.01, 0.2, 1.0);
  const StudyGains gains = engine::choose_gains(views_of(fields), options);
  std::vector<double> stiffness;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto per_field =
        stiffness_with_ramp_slowly(fields[i].view(), options, gains.per_field[i]);
    stiffness.insert(stiffness.end(), per_field.begin(), per_field.end());
    CHECK(engine::field_statistics(fields[i].view(), gains.per_field[i], options)
              .stiffness_p99_n_per_mm == Approx(percentile_slowly(per_field, 0.99)).epsilon(1e-6));
  }
  CHECK(percentile_slowly(stiffness, 0.99) == Approx(0.4).epsilon(1e-6));
  CHECK(gains.per_field[0].normal_n == without.normal_n);
  CHECK(gains.per_field[0].tangential_n < without.tangential_n);
}

TEST_CASE("choose_gains gives all fields one pair of gains unless they are equalised") {
  const std::vector<TextureField> fields = three_fields();
  const StudyGains gains = engine::choose_gains(views_of(fields), {});
  REQUIRE(gains.per_field.size() == 3);
  CHECK(gains.per_field[1] == gains.per_field[0]);
  CHECK(gains.per_field[2] == gains.per_field[0]);
}

TEST_CASE("choose_gains equalises the rms force of all fields") {
  const std::vector<TextureField> fields = three_fields();
  const StudyGains gains = engine::choose_gains(views_of(fields), equalised());
  const double tangential_n =
      gains.per_field[0].tangential_n * tangential_rms(sampled(fields[0].view()).view());
  const double normal_n =
      gains.per_field[0].normal_n * height_rms(sampled(fields[0].view()).view());
  CHECK(tangential_n > 0.0);
  CHECK(normal_n > 0.0);
  for (std::size_t i = 1; i < fields.size(); ++i) {
    const FieldView view = fields[i].view();
    const Gains gain = gains.per_field[i];
    CHECK(gain.tangential_n * tangential_rms(sampled(view).view()) ==
          Approx(tangential_n).epsilon(1e-12));
    CHECK(gain.normal_n * height_rms(sampled(view).view()) == Approx(normal_n).epsilon(1e-12));
  }
}

TEST_CASE("choose_gains gives zero where all fields are flat") {
  const std::vector<TextureField> fields = {flat_field(10, 10), flat_field(5, 5)};
  const RenderingOptions options = GENERATE(RenderingOptions{}, equalised());
  const StudyGains gains = engine::choose_gains(views_of(fields), options);
  CHECK(gains.per_field == std::vector<Gains>{{}, {}});
  CHECK_FALSE(gains.over_budget);
}

TEST_CASE("choose_gains leaves flat fields out of the budget") {
  std::vector<TextureField> fields = {random_field(40, 40, 5)};
  const Gains alone = engine::choose_gains(views_of(fields), {}).per_field[0];
  const Gains alone_equalised = engine::choose_gains(views_of(fields), equalised()).per_field[0];
  fields.push_back(flat_field(400, 400));
  const StudyGains gains = engine::choose_gains(views_of(fields), {});
  CHECK(gains.per_field == std::vector<Gains>{alone, alone});
  const StudyGains equal = engine::choose_gains(views_of(fields), equalised());
  CHECK(equal.per_field == std::vector<Gains>{alone_equalised, Gains{}});
}

TEST_CASE("choose_gains uses the maximum where almost all of a field is flat") {
  const std::vector<TextureField> fields = {
      unfiltered(60, 60, [](int y, int x) { return y == 30 && x == 30 ? 50.0 : 0.0; })};
  const StudyGains gains = engine::choose_gains(views_of(fields), {});
  const auto norms =
      stiffness_slowly(fields[0].view(), {&FieldSample::force_x, &FieldSample::force_y},
                       gains.per_field[0].tangential_n);
  CHECK(percentile_slowly(norms, 0.99) == 0.0);
  CHECK(*std::ranges::max_element(norms) == Approx(0.4).epsilon(1e-6));
}

TEST_CASE("choose_gains cannot judge fields without interior pixels") {
  const std::vector<TextureField> thin = {random_field(2, 50, 6)};
  CHECK(engine::choose_gains(views_of(thin), {}).per_field[0] == Gains{});
  std::vector<TextureField> both = {random_field(40, 40, 5)};
  const Gains alone = engine::choose_gains(views_of(both), {}).per_field[0];
  both.push_back(random_field(2, 50, 6));
  CHECK(engine::choose_gains(views_of(both), {}).per_field == std::vector<Gains>{alone, alone});
}

TEST_CASE("choose_gains uses explicit gains unchanged and reports when they exceed the budget") {
  const std::vector<TextureField> fields = three_fields();
  const Gains allowed = engine::choose_gains(views_of(fields), {}).per_field[0];
  RenderingOptions options{.gains = allowed};
  const StudyGains same = engine::choose_gains(views_of(fields), options);
  CHECK(same.per_field == std::vector<Gains>(3, allowed));
  CHECK_FALSE(same.over_budget);
  options.touchdown_ramp_n = 0.2;
  CHECK(engine::choose_gains(views_of(fields), options).over_budget);
  options.touchdown_ramp_n = 0.0;
  options.gains = Gains{1.001 * allowed.tangential_n, 0.0};
  const StudyGains over = engine::choose_gains(views_of(fields), options);
  CHECK(over.per_field == std::vector<Gains>(3, *options.gains));
  CHECK(over.over_budget);
  options.gains = Gains{0.0, 1.001 * allowed.normal_n};
  CHECK(engine::choose_gains(views_of(fields), options).over_budget);
}

TEST_CASE("choose_gains equalises explicit gains round their mean rms") {
  const std::vector<TextureField> fields = three_fields();
  RenderingOptions options = equalised();
  options.gains = Gains{0.003, 0.002};
  const StudyGains gains = engine::choose_gains(views_of(fields), options);
  double mean_tangential_n = 0.0;
  double mean_normal_n = 0.0;
  for (const TextureField& field : fields) {
    mean_tangential_n += 0.003 * tangential_rms(sampled(field.view()).view()) / 3.0;
    mean_normal_n += 0.002 * height_rms(sampled(field.view()).view()) / 3.0;
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const FieldView view = fields[i].view();
    CHECK(gains.per_field[i].tangential_n * tangential_rms(sampled(view).view()) ==
          Approx(mean_tangential_n).epsilon(1e-12));
    CHECK(gains.per_field[i].normal_n * height_rms(sampled(view).view()) ==
          Approx(mean_normal_n).epsilon(1e-12));
  }
}

TEST_CASE("choose_gains refuses no fields, broken samples and an impossible budget") {
  const std::vector<TextureField> fields = three_fields();
  CHECK_THROWS_AS(engine::choose_gains({}, {}), std::invalid_argument);
  RenderingOptions options;
  const double bad = GENERATE(-1.0, std::nan(""), std::numeric_limits<double>::infinity());
  for (const Gains gains : {Gains{bad, 0.1}, Gains{0.1, bad}}) {
    options.gains = gains;
    CHECK_THROWS_AS(engine::choose_gains(views_of(fields), options), std::invalid_argument);
  }
  options = {};
  options.texture_stiffness_n_per_mm = GENERATE_COPY(0.0, bad);
  CHECK_THROWS_AS(engine::choose_gains(views_of(fields), options), std::invalid_argument);
  std::vector<float> heights(25);
  heights[7] = std::numeric_limits<float>::quiet_NaN();
  const FieldView broken = view_of_heights(heights, 5, 5);
  CHECK_THROWS_AS(engine::choose_gains({&broken, 1}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
