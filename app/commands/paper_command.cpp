// paper: compares the source paper's figures and tables with those of given pictures.
#include "analysis/paper/paper_document.hpp"
#include "analysis/report/figures/gnuplot.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/given_pictures.hpp"
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

constexpr const char* kNumbers = "paper.json";

struct PaperArguments {
  std::vector<fs::path> images;
  fs::path folder;
};

using PaperImages = std::vector<analysis::PaperPicture>;

GreyImage readable_picture(const fs::path& path) {
  GreyImage image = read_given_picture(path);
  if (std::min(image.height(), image.width()) >= engine::kMsSsimSmallestSide) return image;
  throw FileError(fmt::format(
      "{}: has {} x {} px; MS-SSIM needs at least {} px on each side; give "
      "a larger image",
      one_line(path.string()), image.width(), image.height(), engine::kMsSsimSmallestSide));
}

/// The given pictures, named by their files' names without ending, or by their whole paths if two
/// files have one name.
PaperImages pictures_in(const std::vector<fs::path>& paths) {
  std::map<std::string, int> uses;
  for (const fs::path& path : paths) ++uses[path.stem().string()];
  PaperImages pictures;
  for (const fs::path& path : paths) {
    const std::string stem = path.stem().string();
    pictures.push_back({uses[stem] == 1 ? stem : path.string(), readable_picture(path)});
  }
  return pictures;
}

/// The program's own pictures of one kind, as `stimuli generate` makes them.
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
          kNumbers,
          "images/paper-orders.svg",
          "images/paper-sweep.svg",
          "images/paper-forces.svg",
          "images/paper-methods.svg"};
}

void require_places(const fs::path& folder) {
  if (is_there(folder) && !fs::is_directory(folder)) {
    throw FileError(one_line(folder.string()) + ": is not a folder; choose another with --out");
  }
  for (const std::string& name : names_of_output()) require_output_place(folder / name);
}

/// Fig. 3, without an SVG if gnuplot cannot draw it.
analysis::Picture drawn_sweep(const analysis::PaperMeasures& measures) {
  const analysis::Figure figure = analysis::order_figure(measures.pictures);
  analysis::Picture picture{figure.id, figure.caption, figure.alt, ""};
  try {
    analysis::require_gnuplot();
  } catch (const Error& error) {
    std::fputs(
        ("touchtrial: warning: without the figure of orders: " + one_line(error.what()) + "\n")
            .c_str(),
        stderr);
    return picture;
  }
  picture.svg = analysis::drawn(figure, analysis::FigureFormat::svg);
  return picture;
}

void write_paper(const fs::path& folder, const analysis::Document& document,
                 const std::vector<analysis::Picture>& pictures, const std::string& numbers) {
  make_folder(folder / "images");
  write_output(folder / kNumbers, numbers);
  for (const analysis::Picture& one : pictures) {
    if (!one.svg.empty()) write_output(folder / "images" / (one.id + ".svg"), one.svg);
  }
  write_output(folder / "paper.md", analysis::document_markdown(document, "images"));
  write_output(folder / "paper.html", analysis::page_html(document));
}

int make_paper(const PaperArguments& arguments) {
  require_places(arguments.folder);
  const bool own = arguments.images.empty();
  const PaperImages pictures =
      own ? generated_pictures(stimuli::StimulusKind::texture) : pictures_in(arguments.images);
  const PaperImages compared = own ? generated_pictures(stimuli::StimulusKind::object) : pictures;
  const analysis::PaperMeasures measures =
      analysis::measure_for_paper(pictures, compared, progress_bar("measuring"));
  const analysis::PaperPictures drawn = analysis::paper_pictures(pictures, compared);
  const analysis::Picture sweep = drawn_sweep(measures);
  const analysis::Document document = analysis::paper_document(
      measures, drawn, sweep,
      own ? "the textures and objects that this program draws itself (docs/stimuli.md)"
          : "the given pictures");
  write_paper(arguments.folder, document, {drawn.orders, sweep, drawn.forces, drawn.methods},
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
