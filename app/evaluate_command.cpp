#include "analysis/figures/gnuplot.hpp"
#include "analysis/measures/evaluation_report.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/force_flag.hpp"
#include "core/errors.hpp"
#include "core/outputs.hpp"
#include "engine/image_file.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
  std::vector<fs::path> images;
  bool sweep = false;
  bool json = false;
  fs::path picture;
};

analysis::EvaluatedImage evaluated(const fs::path& path, bool sweep,
                                   const std::function<void()>& order_done) {
  const GreyImage image = engine::read_grey_image(path);
  try {
    return {path.string(), engine::evaluate_image(image, sweep, order_done)};
  } catch (const std::invalid_argument& error) {
    throw FileError(one_line(path.string()) + ": " + error.what() + "; give a larger image" +
                    (sweep ? " or omit --sweep" : ""));
  }
}

std::vector<analysis::EvaluatedImage> evaluated(const EvaluateArguments& arguments) {
  const auto bar = progress_bar("evaluating");
  const int steps_of_image = arguments.sweep ? engine::kSweptOrders : 1;
  const int steps = static_cast<int>(arguments.images.size()) * steps_of_image;
  int done = 0;
  std::vector<analysis::EvaluatedImage> images;
  for (const fs::path& path : arguments.images) {
    images.push_back(evaluated(path, arguments.sweep, [&] { bar(++done, steps); }));
    if (!arguments.sweep) bar(++done, steps);
  }
  return images;
}

int evaluate(const EvaluateArguments& arguments) {
  if (!arguments.picture.empty()) {
    require_output_place(arguments.picture);
    analysis::require_gnuplot();
  }
  const std::vector<analysis::EvaluatedImage> images = evaluated(arguments);
  if (!arguments.picture.empty()) {
    analysis::draw_with_gnuplot(analysis::order_sweep_script(images), arguments.picture);
  }
  print(arguments.json ? analysis::evaluation_json(images) : analysis::evaluation_text(images));
  return 0;
}

}  // namespace

void add_evaluate_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = program.add_subcommand(
      "evaluate", "Co-occurrence statistics of images and their textures; the order sweep");
  command->add_option("IMAGE", arguments->images, "PNG, JPEG, TIFF, BMP or PGM")->required();
  CLI::Option* sweep = command->add_flag("--sweep", arguments->sweep,
                                         "Compare the adaptive texture with fixed orders, 0.05 "
                                         "to 0.95, by MS-SSIM");
  command
      ->add_option("--picture", arguments->picture,
                   "Draw the curves of the sweep as PNG (needs gnuplot)")
      ->needs(sweep);
  add_force_flag(*command);
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return evaluate(*arguments); }; });
}

}  // namespace touchtrial::app
