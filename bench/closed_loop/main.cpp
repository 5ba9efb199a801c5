// Sweeps of the closed loop of hand and plane: prints tables and draws pictures into a folder.
#include "analysis/figures/gnuplot.hpp"
#include "bench/closed_loop/texture_loop.hpp"
#include "bench/closed_loop/wall_sweeps.hpp"
#include "engine/extraction.hpp"
#include "engine/image_file.hpp"
#include "engine/rendering/gains.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::bench {
namespace {

constexpr std::array kTextureNPerMm = {0.1, 0.2, 0.4, 0.8, 1.2, 1.6, 3.2, 6.4, 12.8};
constexpr double kUsualMmPerS = 100.0;
constexpr std::array kTextures = {"bark", "cloth", "pebbles", "straw", "brick"};

struct Worst {
  double slow_mm_s = 0.0;     ///< vibration of a slow stroke, median over textures
  double slowest_mm_s = 0.0;  ///< the same, maximum over textures
  double lost_per_s = 0.0;    ///< contacts lost in a usual stroke, median
  double most_lost_per_s = 0.0;
};

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

Worst stroke_all(const std::vector<Plane<double>>& textures,
                 const engine::RenderingOptions& options) {
  std::vector<double> vibration;
  std::vector<double> lost;
  for (const Plane<double>& texture : textures) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const Chatter slow = stroke_texture(texture, options, {.seed = seed});
      const Chatter usual =
          stroke_texture(texture, options, {.speed_mm_s = kUsualMmPerS, .seed = seed});
      vibration.push_back(slow.vibration_mm_s);
      lost.push_back(usual.lost_contacts_per_s);
    }
  }
  return {median(vibration), *std::ranges::max_element(vibration), median(lost),
          *std::ranges::max_element(lost)};
}

std::string sweep_texture(const std::vector<Plane<double>>& textures) {
  std::string data;
  std::puts(
      "\nmodel    N/mm  vibration mm/s at 2 mm/s: median, largest   "
      "lost contacts/s at 100 mm/s: median, largest");
  for (const engine::ModelKind model : {engine::ModelKind::paper, engine::ModelKind::surface}) {
    const char* name = model == engine::ModelKind::paper ? "paper" : "surface";
    data += fmt::format("${} << EOD\n", name);
    for (const double stiffness : kTextureNPerMm) {
      engine::RenderingOptions options;
      options.model = model;
      options.texture_stiffness_n_per_mm = stiffness;
      const Worst worst = stroke_all(textures, options);
      data += fmt::format("{} {} {} {} {}\n", stiffness, worst.slow_mm_s, worst.slowest_mm_s,
                          worst.lost_per_s, worst.most_lost_per_s);
      fmt::print("{:8} {:5} {:12.4f} {:10.4f} {:20.2f} {:8.2f}\n", name, stiffness, worst.slow_mm_s,
                 worst.slowest_mm_s, worst.lost_per_s, worst.most_lost_per_s);
    }
    data += "EOD\n";
  }
  return data;
}

/// Median and maximum of both models, from these columns.
std::string both_models(int median_column, int largest_column) {
  std::string plot = "plot ";
  for (const auto& [name, colour] : {std::pair{"paper", kColours[1]}, {"surface", kColours[0]}}) {
    plot += fmt::format(
        "{0}${1} using 1:{2} with linespoints pt 7 lw 1.8 lc rgb '{4}' title 'model {1}, median', "
        "${1} using 1:{3} with linespoints pt 6 dt 2 lw 1.4 lc rgb '{4}' "
        "title 'model {1}, largest'",
        plot.size() > 5 ? ", " : "", name, median_column, largest_column, colour);
  }
  return plot + "\n";
}

std::string draw_texture(bool png, const std::vector<Plane<double>>& textures) {
  return picture_head(png, 1040, 440) + sweep_texture(textures) +
         "set multiplot layout 1,2\nset logscale x\nset xrange [0.085:15]\n"
         "set xlabel 'stiffness budget of the texture, N/mm'\n"
         "set xtics (0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4, 12.8)\n"
         "set arrow from 0.4, graph 0 to 0.4, graph 0.62 nohead dt 2 lw 1.4 lc rgb '#888888'\n"
         "set label 'default' at 0.41, graph 0.6 tc rgb '#666666'\n"
         "set logscale y\nset format y '%g'\nset yrange [0.0005:1000]\n"
         "set ylabel 'vibration above 30 Hz, mm/s (rms)'\nset title 'stroked at 2 mm/s'\n" +
         both_models(2, 3) +
         "unset logscale y\nset yrange [0:50]\nset ylabel 'contacts lost a second'\n"
         "set title 'stroked at 100 mm/s'\n" +
         both_models(4, 5) + "unset multiplot\n";
}

/// Prints the lateral steps of landings on all textures together, as strong as a study of them has
/// them.
void print_touchdowns(const std::vector<Plane<double>>& textures,
                      const engine::RenderingOptions& options) {
  constexpr int kLandings = 40;
  std::vector<engine::TextureField> fields;
  std::vector<engine::FieldView> views;
  for (const auto& texture : textures) fields.push_back(make_texture_field(texture, options));
  for (const engine::TextureField& field : fields) views.push_back(field.view());
  const std::vector<engine::Gains> gains = engine::choose_gains(views, options).of_field;
  std::vector<double> rms;
  std::vector<double> first;
  std::vector<double> within;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const engine::RenderingModel model(views[i], options, gains[i]);
    for (std::uint64_t seed = 1; seed <= kLandings; ++seed) {
      const Touchdown landing = touch_down(
          model, views[i].geometry, {.speed_mm_s = kUsualMmPerS, .time_s = 2.0, .seed = seed});
      rms.push_back(landing.rms_n);
      first.push_back(landing.step_n);
      within.push_back(landing.largest_step_n);
    }
  }
  const auto largest = [](const std::vector<double>& steps) {
    return *std::ranges::max_element(steps);
  };
  fmt::print("{:8} {:5} {:10.5f} {:7.3f} {:9.3f} {:8.3f} {:10.3f} {:8.3f}\n",
             options.model == engine::ModelKind::paper ? "paper" : "surface",
             options.touchdown_ramp_n, gains.front().tangential_n, median(rms), median(first),
             largest(first), median(within), largest(within));
}

void print_all_touchdowns(const std::vector<Plane<double>>& textures) {
  std::puts(
      "\nlateral force of landings at 100 mm/s, N\n"
      "model    ramp N      k_t     rms   first ms: median, largest   any ms of 20: median, "
      "largest");
  for (const double ramp_n : {0.0, 0.05, 0.1, 0.2, 0.4, 0.7}) {
    engine::RenderingOptions options;
    options.touchdown_ramp_n = ramp_n;
    print_touchdowns(textures, options);
  }
  engine::RenderingOptions surface;
  surface.model = engine::ModelKind::surface;
  print_touchdowns(textures, surface);
}

/// The middle of a texture, 40 mm wide at the default pitch.
Plane<double> middle_of(const Plane<double>& texture) {
  constexpr int kSidePx = 200;
  Plane<double> part(kSidePx, kSidePx);
  const int top = (texture.height() - kSidePx) / 2;
  const int left = (texture.width() - kSidePx) / 2;
  for (int y = 0; y < kSidePx; ++y) {
    for (int x = 0; x < kSidePx; ++x) part.at(y, x) = texture.at(top + y, left + x);
  }
  return part;
}

std::vector<Plane<double>> textures_of(const std::filesystem::path& stimuli) {
  std::vector<Plane<double>> textures;
  for (const char* name : kTextures) {
    const GreyImage image = engine::read_grey_image(stimuli / (std::string(name) + ".png"));
    textures.push_back(engine::extract_texture<double>(image, {}).texture);
  }
  return textures;
}

void run(const std::filesystem::path& stimuli, const std::filesystem::path& out, bool png) {
  analysis::require_gnuplot();
  const std::string ending = png ? ".png" : ".svg";
  for (const WallPicture& picture : wall_pictures(png)) {
    analysis::draw_with_gnuplot(picture.script, out / (picture.name + ending));
    std::fflush(stdout);
  }
  print_quantised_walls();
  print_device_models();
  std::fflush(stdout);
  std::vector<Plane<double>> textures = textures_of(stimuli);
  print_all_touchdowns(textures);
  for (Plane<double>& texture : textures) texture = middle_of(texture);
  analysis::draw_with_gnuplot(draw_texture(png, textures), out / ("chatter" + ending));
}

}  // namespace
}  // namespace touchtrial::bench

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fputs("usage: closed_loop STIMULI_FOLDER PICTURE_FOLDER [png]\n", stderr);
    return 2;
  }
  try {
    touchtrial::bench::run(argv[1], argv[2], argc == 4 && std::string(argv[3]) == "png");
  } catch (const std::exception& error) {
    fmt::print(stderr, "closed_loop: {}\n", error.what());
    return 1;
  }
  return 0;
}
