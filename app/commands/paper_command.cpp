// paper: compares pictures with the source paper's figures and tables.
#include "analysis/paper/paper_document.hpp"
#include "analysis/report/figures/gnuplot.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/input_pictures.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "engine/metrics/ssim.hpp"
#include "stimuli/generator.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNumbersFile = "paper.json";

struct PaperArguments {
  std::vector<fs::path> images;
  fs::path folder;
};

using PaperImages = std::vector<analysis::PaperPicture>;

GreyImage read_large_picture(const fs::path& path) {
  GreyImage image = read_input_picture(path);
  if (std::min(image.height(), image.width()) >= engine::kMsSsimSmallestSide) return image;
  throw FileError(fmt::format(
      "{}: has {} x {} px; MS-SSIM needs at least {} px on each side; give "
      "a larger image",
      one_line(path.string()), image.width(), image.height(), engine::kMsSsimSmallestSide));
}

/// The given pictures, named after their files without extension, or after their full paths if two
/// files have the same name.
PaperImages read_pictures(const std::vector<fs::path>& paths) {
  std::map<std::string, int> count_by_stem;
  for (const fs::path& path : paths) ++count_by_stem[path.stem().string()];
  PaperImages pictures;
  for (const fs::path& path : paths) {
    const std::string stem = path.stem().string();
    pictures.push_back({count_by_stem[stem] == 1 ? stem : path.string(), read_large_picture(path)});
  }
  return pictures;
}

/// The built-in pictures of one kind, as `stimuli generate` makes them.
PaperImages generated_pictures(stimuli::StimulusKind kind) {
  PaperImages pictures;
  for (const stimuli::StimulusRecipe& recipe : stimuli::stimulus_recipes()) {
    if (recipe.kind != kind) continue;
    pictures.push_back({std::string(recipe.label),
                        stimuli::generate_stimulus(recipe.label, stimuli::kDefaultStimuliSeed)});
  }
  return pictures;
}

/// The names of all files that the command writes, whether drawn or not.
std::vector<std::string> names_of_output() {
  return {"paper.md",
          "paper.html",
          kNumbersFile,
          "images/paper-orders.svg",
          "images/paper-sweep.svg",
          "images/paper-forces.svg",
          "images/paper-methods.svg"};
}

void require_places(const fs::path& folder) {
  if (path_exists(folder) && !fs::is_directory(folder)) {
    throw FileError(one_line(folder.string()) + ": is not a folder; choose another with --out");
  }
  for (const std::string& name : names_of_output()) require_output_path(folder / name);
}

/// Fig. 3, without an SVG if gnuplot cannot draw it.
analysis::Picture draw_sweep(const analysis::PaperMeasures& measures) {
  const analysis::Figure figure = analysis::order_figure(measures.pictures);
  analysis::Picture picture{figure.id, figure.caption, figure.alt, ""};
  try {
    analysis::require_gnuplot();
  } catch (const Error& error) {
    std::fputs(
        ("touchtrial: warning: the figure of orders is left out: " + one_line(error.what()) + "\n")
            .c_str(),
        stderr);
    return picture;
  }
  picture.svg = analysis::draw_figure(figure, analysis::FigureFormat::svg);
  return picture;
}

void write_paper(const fs::path& folder, const analysis::Document& document,
                 const std::vector<analysis::Picture>& pictures, const std::string& numbers) {
  make_folder(folder / "images");
  write_output(folder / kNumbersFile, numbers);
  for (const analysis::Picture& picture : pictures) {
    if (picture.svg.empty()) continue;
    write_output(folder / "images" / (picture.id + ".svg"), picture.svg);
  }
  write_output(folder / "paper.md", analysis::document_markdown(document, "images"));
  write_output(folder / "paper.html", analysis::page_html(document));
}

int make_paper(const PaperArguments& arguments) {
  require_places(arguments.folder);
  const bool uses_builtin = arguments.images.empty();
  const PaperImages pictures = uses_builtin ? generated_pictures(stimuli::StimulusKind::texture)
                                            : read_pictures(arguments.images);
  const PaperImages comparison_pictures =
      uses_builtin ? generated_pictures(stimuli::StimulusKind::object) : pictures;
  const analysis::PaperMeasures measures =
      analysis::measure_for_paper(pictures, comparison_pictures, progress_bar("measuring"));
  const analysis::PaperPictures drawings = analysis::paper_pictures(pictures, comparison_pictures);
  const analysis::Picture sweep = draw_sweep(measures);
  const analysis::Document document = analysis::paper_document(
      measures, drawings, sweep,
      uses_builtin ? "the textures and objects that this program draws itself (docs/stimuli.md)"
                   : "the given pictures");
  write_paper(arguments.folder, document,
              {drawings.orders, sweep, drawings.forces, drawings.methods},
              analysis::paper_json(measures));
  print((arguments.folder / "paper.html").string() + "\n" +
        (arguments.folder / "paper.md").string() + "\n");
  return 0;
}

}  // namespace

void add_paper_command(CLI::App& program, Action& action) {
  const auto [command, arguments] =
      add_command(program, action, "paper",
                  "Compare pictures with the source paper's figures and tables", make_paper);
  command.add_option(
      "IMAGE", arguments.images,
      "PNG, JPEG, TIFF, BMP, GIF or PGM (default: the program's own textures, and its "
      "objects for the comparison with TV-Gabor)");
  command
      .add_option("-o,--out", arguments.folder,
                  "Folder for paper.html, paper.md, the pictures and paper.json")
      ->required();
  add_force_flag(command);
}

}  // namespace touchtrial::app
