// Simulates the closed loop of hand and plane, and prints the tables of docs/benchmarks/README.md
// and of "Steps at touchdown" in docs/method.md.
#include "bench/closed_loop/texture_loop.hpp"
#include "engine/extraction.hpp"
#include "engine/image_file.hpp"
#include "engine/rendering/gains.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::bench {
namespace {

constexpr double kTypicalMmPerS = 100.0;

/// Prints the header of a Markdown table.
void print_heading(const std::string& names) {
  std::string rule = "|";
  for (const char c : names.substr(1)) {
    if (c == '|') rule += " ---: |";
  }
  fmt::print("\n{}\n{}\n", names, rule);
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

using Textures = std::vector<Plane<double>>;

const char* name_of(engine::ModelKind model) {
  return model == engine::ModelKind::paper ? "`paper`" : "`surface`";
}

/// Prints the lateral steps at touchdown on all textures, with the gains of a study with these
/// textures.
void print_touchdowns(const Textures& textures, const engine::RenderingOptions& options) {
  constexpr int kLandings = 40;
  std::vector<engine::TextureField> fields;
  std::vector<engine::FieldView> views;
  for (const auto& texture : textures) fields.push_back(make_texture_field(texture, options));
  for (const engine::TextureField& field : fields) views.push_back(field.view());
  const std::vector<engine::Gains> gains = engine::choose_gains(views, options).per_field;
  std::vector<double> rms, first_steps, max_steps;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const engine::RenderingModel model(views[i], options, gains[i]);
    for (std::uint64_t seed = 1; seed <= kLandings; ++seed) {
      const Touchdown landing = touch_down(
          model, views[i].geometry, {.speed_mm_s = kTypicalMmPerS, .time_s = 2.0, .seed = seed});
      rms.push_back(landing.rms_n);
      first_steps.push_back(landing.step_n);
      max_steps.push_back(landing.largest_step_n);
    }
  }
  fmt::print("| {} | {} | {:.5f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n",
             name_of(options.model), options.touchdown_ramp_n, gains.front().tangential_n,
             median(rms), median(first_steps), std::ranges::max(first_steps), median(max_steps),
             std::ranges::max(max_steps));
}

void print_all_touchdowns(const Textures& textures) {
  print_heading(
      "| model | ramp, N | k_t | rms, N | first ms: median | largest | any of 20 ms: median | "
      "largest |");
  engine::RenderingOptions options;
  for (const double ramp_n : {0.0, 0.05, 0.1, 0.2, 0.4, 0.7}) {
    options.touchdown_ramp_n = ramp_n;
    print_touchdowns(textures, options);
  }
  engine::RenderingOptions surface;
  surface.model = engine::ModelKind::surface;
  print_touchdowns(textures, surface);
}

/// \return the middle of a texture, 40 mm wide at the default pitch
Plane<double> middle_of(const Plane<double>& texture) {
  constexpr int kSidePx = 200;
  Plane<double> part(kSidePx, kSidePx);
  for (int y = 0; y < kSidePx; ++y) {
    const auto row = texture.row((texture.height() - kSidePx) / 2 + y);
    std::ranges::copy(row.subspan(static_cast<std::size_t>(texture.width() - kSidePx) / 2, kSidePx),
                      part.row(y).begin());
  }
  return part;
}

void print_chatter(const Textures& textures) {
  print_heading(
      "| model | N/mm | vibration at 2 mm/s: median, mm/s | largest | contacts lost a second at "
      "100 mm/s: median | largest |");
  for (const engine::ModelKind model : {engine::ModelKind::paper, engine::ModelKind::surface}) {
    for (const double stiffness : {0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4, 12.8}) {
      engine::RenderingOptions options;
      options.model = model;
      options.texture_stiffness_n_per_mm = stiffness;
      std::vector<double> vibration, lost;
      for (const Plane<double>& texture : textures) {
        const Plane<double> middle = middle_of(texture);
        for (std::uint64_t seed = 1; seed <= 2; ++seed) {
          vibration.push_back(stroke_texture(middle, options, {.seed = seed}).vibration_mm_s);
          lost.push_back(
              stroke_texture(middle, options, {.speed_mm_s = kTypicalMmPerS, .seed = seed})
                  .lost_contacts_per_s);
        }
      }
      fmt::print("| {} | {} | {:.4f} | {:.4f} | {:.1f} | {:.1f} |\n", name_of(model), stiffness,
                 median(vibration), std::ranges::max(vibration), median(lost),
                 std::ranges::max(lost));
    }
  }
}

void run(const std::filesystem::path& stimuli) {
  Textures textures;
  for (const char* name : {"bark", "cloth", "pebbles", "straw", "brick"}) {
    const GreyImage image = engine::read_grey_image(stimuli / (std::string(name) + ".png"));
    textures.push_back(engine::extract_texture<double>(image, {}).texture);
  }
  print_chatter(textures);
  print_all_touchdowns(textures);
}

}  // namespace
}  // namespace touchtrial::bench

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: closed_loop STIMULI_FOLDER\n", stderr);
    return 2;
  }
  try {
    touchtrial::bench::run(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "closed_loop: {}\n", error.what());
    return 1;
  }
  return 0;
}
