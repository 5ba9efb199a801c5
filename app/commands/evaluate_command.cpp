// evaluate: prints co-occurrence statistics of pictures and their textures.
#include "analysis/measures/evaluation_report.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/input_pictures.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
  std::vector<fs::path> images;
  engine::SampleScale scale;
  bool sweep = false;
  bool json = false;
};

analysis::EvaluatedImage evaluate_file(const fs::path& path, const engine::SampleScale& scale,
                                       bool sweep, const std::function<void()>& on_order_done) {
  const GreyImage image = read_input_picture(path, scale);
  try {
    return {path.string(), engine::evaluate_image(image, sweep, on_order_done)};
  } catch (const std::invalid_argument& error) {
    throw FileError(one_line(path.string()) + ": " + error.what() + "; give a larger image" +
                    (sweep ? " or omit --sweep" : ""));
  }
}

std::vector<analysis::EvaluatedImage> evaluate_files(const EvaluateArguments& arguments) {
  const auto bar = progress_bar("evaluating");
  const int steps_of_image = arguments.sweep ? engine::kSweptOrders : 1;
  const int steps = static_cast<int>(arguments.images.size()) * steps_of_image;
  int done = 0;
  std::vector<analysis::EvaluatedImage> images;
  for (const fs::path& path : arguments.images) {
    images.push_back(
        evaluate_file(path, arguments.scale, arguments.sweep, [&] { bar(++done, steps); }));
    if (!arguments.sweep) bar(++done, steps);
  }
  return images;
}

int evaluate(const EvaluateArguments& arguments) {
  const std::vector<analysis::EvaluatedImage> images = evaluate_files(arguments);
  print(arguments.json ? analysis::evaluation_json(images) : analysis::evaluation_text(images));
  return 0;
}

}  // namespace

void add_evaluate_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "evaluate",
      "Print co-occurrence statistics of images and their textures; optionally sweep the order",
      evaluate);
  command.add_option("IMAGE", arguments.images, "PNG, JPEG, TIFF, BMP, GIF or PGM")->required();
  add_sample_options(command, arguments.scale);
  command.add_flag("--sweep", arguments.sweep,
                   "Compare the adaptive texture with fixed orders, 0.05 to 0.95, by MS-SSIM");
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
