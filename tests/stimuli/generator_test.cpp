#include "stimuli/generator.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>
#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::stimuli;

namespace {

double mean_of(const GreyImage& image) {
  double sum = 0.0;
  for (const std::uint8_t grey : image.samples()) sum += grey;
  return sum / static_cast<double>(image.size());
}

double share_of(const GreyImage& image, int low, int high) {
  const auto inside = [&](std::uint8_t grey) { return grey >= low && grey <= high; };
  return static_cast<double>(
             std::count_if(image.samples().begin(), image.samples().end(), inside)) /
         static_cast<double>(image.size());
}

/// Correlation of the picture with itself moved by (dx, dy), over the part that overlaps.
double self_correlation(const GreyImage& image, int dx, int dy) {
  double sum_a = 0.0, sum_b = 0.0, sum_aa = 0.0, sum_bb = 0.0, sum_ab = 0.0, n = 0.0;
  for (int y = 0; y + dy < image.height(); ++y) {
    for (int x = 0; x + dx < image.width(); ++x) {
      const double a = image.at(y, x);
      const double b = image.at(y + dy, x + dx);
      sum_a += a;
      sum_b += b;
      sum_aa += a * a;
      sum_bb += b * b;
      sum_ab += a * b;
      n += 1.0;
    }
  }
  const double covariance = sum_ab / n - sum_a / n * (sum_b / n);
  const double variance_a = sum_aa / n - sum_a / n * (sum_a / n);
  const double variance_b = sum_bb / n - sum_b / n * (sum_b / n);
  return covariance / std::sqrt(variance_a * variance_b);
}

/// The mean square difference of neighbours along rows, divided by that along columns.
double anisotropy(const GreyImage& image) {
  double along_rows = 0.0;
  double along_columns = 0.0;
  for (int y = 0; y + 1 < image.height(); ++y) {
    for (int x = 0; x + 1 < image.width(); ++x) {
      const double here = image.at(y, x);
      along_rows += (image.at(y, x + 1) - here) * (image.at(y, x + 1) - here);
      along_columns += (image.at(y + 1, x) - here) * (image.at(y + 1, x) - here);
    }
  }
  return along_rows / along_columns;
}

constexpr int kSmall = 192;

std::vector<StimulusRecipe> recipes_of(std::initializer_list<StimulusKind> kinds) {
  std::vector<StimulusRecipe> recipes;
  for (const StimulusRecipe& recipe : stimulus_recipes()) {
    if (std::count(kinds.begin(), kinds.end(), recipe.kind) > 0) recipes.push_back(recipe);
  }
  return recipes;
}

/// All recipes that fill the picture with something to feel.
std::vector<StimulusRecipe> surfaces() {
  return recipes_of({StimulusKind::texture, StimulusKind::material, StimulusKind::practice});
}

double deviation_of(const GreyImage& image) {
  const double mean = mean_of(image);
  double sum = 0.0;
  for (const std::uint8_t grey : image.samples()) sum += (grey - mean) * (grey - mean);
  return std::sqrt(sum / static_cast<double>(image.size()));
}

/// Mean absolute difference, grey levels.
double difference_of(const GreyImage& a, const GreyImage& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a.samples()[i] - b.samples()[i]);
  return sum / static_cast<double>(a.size());
}

}  // namespace

TEST_CASE("there are recipes of every kind, each with its own label") {
  std::set<std::string> labels;
  for (const StimulusRecipe& recipe : stimulus_recipes()) labels.insert(std::string(recipe.label));
  CHECK(labels.size() == 17);
  CHECK(recipes_of({StimulusKind::texture}).size() == 5);
  CHECK(recipes_of({StimulusKind::object}).size() == 4);
  CHECK(recipes_of({StimulusKind::material}).size() == 4);
  CHECK(recipes_of({StimulusKind::practice}).size() == 3);
  CHECK(recipes_of({StimulusKind::flat}).size() == 1);
  for (const char* label : {"bark", "cloth", "pebbles", "straw", "brick"}) {
    CHECK(labels.count(label) == 1);
  }
}

TEST_CASE("the same label and seed give the same picture, another seed another") {
  for (const StimulusRecipe& recipe : stimulus_recipes()) {
    INFO(recipe.label);
    const GreyImage picture = generate_stimulus(recipe.label, 7, 96);
    CHECK(picture.height() == 96);
    CHECK(picture.width() == 96);
    CHECK(picture == generate_stimulus(recipe.label, 7, 96));
    const bool is_flat = recipe.kind == StimulusKind::flat;
    CHECK((picture == generate_stimulus(recipe.label, 8, 96)) == is_flat);
  }
}

TEST_CASE("exemplars of a surface are as different as surfaces of two seeds") {
  for (const StimulusRecipe& recipe : surfaces()) {
    INFO(recipe.label);
    const GreyImage first = generate_stimulus(recipe.label, 7, 96);
    const GreyImage third = generate_stimulus(recipe.label, 7, 96, 3);
    CHECK(third == generate_stimulus(recipe.label, 7, 96, 3));
    CHECK(difference_of(first, third) > 0.6 * deviation_of(first));
    CHECK(difference_of(generate_stimulus(recipe.label, 7, 96, 2), third) >
          0.6 * deviation_of(first));
  }
}

TEST_CASE("exemplars of an object show the same object, turned and lit differently") {
  for (const StimulusRecipe& recipe : recipes_of({StimulusKind::object})) {
    INFO(recipe.label);
    const GreyImage first = generate_stimulus(recipe.label, 7, 96);
    const GreyImage second = generate_stimulus(recipe.label, 7, 96, 2);
    CHECK(difference_of(first, second) > 5.0);
    CHECK(share_of(second, second.at(0, 0), second.at(0, 0)) > 0.1);
  }
}

TEST_CASE("a flat picture has one grey, the middle one, for any seed and exemplar") {
  const GreyImage flat = generate_stimulus("flat", 7, 32, 3);
  CHECK(flat == GreyImage(32, 32, 128));
  CHECK(flat == generate_stimulus("flat", 8, 32));
}

TEST_CASE("kinds have names that lead back to them") {
  for (const StimulusRecipe& recipe : stimulus_recipes()) {
    CHECK(stimulus_kind_from_name(name_of(recipe.kind)) == recipe.kind);
  }
  CHECK_FALSE(stimulus_kind_from_name("sound").has_value());
}

TEST_CASE("two seeds of a texture are different surfaces, not shifted or re-lit ones") {
  for (const StimulusRecipe& recipe : surfaces()) {
    INFO(recipe.label);
    const GreyImage a = generate_stimulus(recipe.label, 1, 96);
    const GreyImage b = generate_stimulus(recipe.label, 2, 96);
    const auto same = [&](std::size_t i) { return a.samples()[i] == b.samples()[i]; };
    std::size_t equal = 0;
    for (std::size_t i = 0; i < a.size(); ++i) equal += same(i) ? 1 : 0;
    CHECK(equal < a.size() / 20);
  }
}

TEST_CASE("a surface uses the range of greys round a middle mean, and clips little") {
  for (const StimulusRecipe& recipe : surfaces()) {
    for (const int exemplar : {1, 2}) {
      INFO(recipe.label << " " << exemplar);
      const GreyImage picture =
          generate_stimulus(recipe.label, kDefaultStimuliSeed, kSmall, exemplar);
      CHECK(mean_of(picture) > 100.0);
      CHECK(mean_of(picture) < 145.0);
      CHECK(deviation_of(picture) > 25.0);
      CHECK(deviation_of(picture) < 75.0);
      CHECK(share_of(picture, 0, 1) < 0.01);
      CHECK(share_of(picture, 254, 255) < 0.01);
    }
  }
}

TEST_CASE("an object fills most of its picture, and its ground is plain") {
  for (const StimulusRecipe& recipe : recipes_of({StimulusKind::object})) {
    INFO(recipe.label);
    const GreyImage picture = generate_stimulus(recipe.label, kDefaultStimuliSeed, kSmall);
    const int ground = picture.at(0, 0);
    CHECK(picture.at(0, kSmall - 1) == ground);
    CHECK(share_of(picture, ground, ground) > 0.1);
    CHECK(share_of(picture, ground, ground) < 0.6);
    CHECK(mean_of(picture) > 100.0);
    CHECK(mean_of(picture) < 150.0);
  }
}

TEST_CASE("no surface repeats itself: shifted far, it does not resemble itself") {
  for (const StimulusRecipe& recipe : surfaces()) {
    const GreyImage picture = generate_stimulus(recipe.label, kDefaultStimuliSeed, 256);
    // Every second stake of a wicker wall, 60 pixels on, is woven alike.
    const int near_px = recipe.label == "wicker" ? 90 : 60;
    for (int dy = 0; dy <= 128; dy += 16) {
      for (int dx = 0; dx <= 128; dx += 2) {
        if (dx * dx + dy * dy < near_px * near_px) continue;
        INFO(recipe.label << ", moved by " << dx << ", " << dy);
        REQUIRE(self_correlation(picture, dx, dy) < 0.6);
      }
    }
  }
}

TEST_CASE("bark's furrows are vertical, straw and courses of brick horizontal") {
  const auto of = [](const char* label) {
    return anisotropy(generate_stimulus(label, kDefaultStimuliSeed, kSmall));
  };
  CHECK(of("bark") > 2.0);
  CHECK(of("straw") < 0.6);
  CHECK(of("brick") < 0.9);
  CHECK(of("pebbles") > 0.8);
  CHECK(of("pebbles") < 1.25);
}

TEST_CASE("a texture keeps the size of its features in a larger picture") {
  for (const StimulusRecipe& recipe : recipes_of({StimulusKind::texture})) {
    INFO(recipe.label);
    const double small = self_correlation(generate_stimulus(recipe.label, 3, 128), 2, 0);
    const double large = self_correlation(generate_stimulus(recipe.label, 3, 256), 2, 0);
    CHECK(small == Approx(large).margin(0.08));
  }
}

TEST_CASE("an unknown label is refused with the known ones, and a size out of range") {
  CHECK_THROWS_AS(generate_stimulus("velvet", 1), UsageError);
  CHECK_THROWS_WITH(generate_stimulus("velvet", 1), holds_text("velvet") && holds_text("pebbles"));
  CHECK_THROWS_AS(generate_stimulus("bark", 1, kMinStimulusSizePx - 1), UsageError);
  CHECK_THROWS_AS(generate_stimulus("bark", 1, kMaxStimulusSizePx + 1), UsageError);
  CHECK_THROWS_AS(generate_stimulus("flat", 1, 32, 0), UsageError);
  CHECK_THROWS_AS(generate_stimulus("flat", 1, 32, kMaxStimulusExemplars + 1), UsageError);
}

TEST_CASE("the smallest pictures can be made") {
  for (const StimulusRecipe& recipe : stimulus_recipes()) {
    CHECK(generate_stimulus(recipe.label, 5, kMinStimulusSizePx).width() == kMinStimulusSizePx);
  }
}
