// stimuli measure: computes statistics of pictures.
#include "analysis/measures/picture_set.hpp"
#include "app/commands/commands.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "engine/image_file.hpp"
#include "engine/metrics/picture_statistics.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct MeasureArguments {
  std::vector<fs::path> inputs;
  fs::path photographs;
  bool json = false;
};

/// Pictures, and the rules for their forces.
struct MeasureJob {
  std::vector<analysis::LabelledPicture> pictures;
  std::optional<study::Study> rules;  ///< the first study of the command line
};

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool is_picture(const fs::path& path) {
  constexpr std::array<std::string_view, 9> kEndings = {".png", ".jpg", ".jpeg", ".tif", ".tiff",
                                                        ".bmp", ".pgm", ".ppm",  ".pnm"};
  return std::ranges::find(kEndings, ending_of(path)) != kEndings.end();
}

void add_picture(MeasureJob& job, const std::string& set, const std::string& label,
                 const fs::path& path) {
  job.pictures.push_back(
      {set, label, one_line(path.lexically_normal().string()), engine::read_grey_image(path)});
}

void add_study(MeasureJob& job, const fs::path& path) {
  const study::Study study = study::load_study(path);
  for (const study::StudyClass& study_class : study.classes) {
    for (const fs::path& image : study_class.images) {
      add_picture(job, study.name, study_class.label, study.folder / image);
    }
  }
  if (!job.rules) job.rules = study;
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> entries;
  for (fs::directory_iterator i(folder, error); !error && i != fs::directory_iterator();
       i.increment(error)) {
    entries.push_back(i->path());
  }
  if (error) {
    throw FileError(one_line(folder.string()) + ": cannot be read (" + error.message() +
                    "); check the path");
  }
  std::ranges::sort(entries);
  return entries;
}

/// Adds the pictures of a folder: each subfolder is a class, and each picture directly in it is a
/// class.
void add_folder(MeasureJob& job, const fs::path& folder, const std::string& set) {
  const std::size_t previous_count = job.pictures.size();
  for (const fs::path& entry : sorted_entries(folder)) {
    if (is_folder(entry)) {
      for (const fs::path& file : sorted_entries(entry)) {
        if (is_picture(file)) add_picture(job, set, entry.filename().string(), file);
      }
    } else if (is_picture(entry)) {
      add_picture(job, set, entry.stem().string(), entry);
    }
  }
  if (job.pictures.size() == previous_count) {
    throw FileError(one_line(folder.string()) +
                    ": contains no picture; give a folder of photographs");
  }
}

MeasureJob read_inputs(const MeasureArguments& arguments) {
  MeasureJob job;
  for (const fs::path& input : arguments.inputs) {
    if (is_folder(input)) {
      add_folder(job, input, input.string());
    } else if (ending_of(input) == ".json") {
      add_study(job, input);
    } else {
      add_picture(job, "pictures", input.stem().string(), input);
    }
  }
  if (!arguments.photographs.empty()) add_folder(job, arguments.photographs, "photographs");
  return job;
}

void refuse_too_small(const analysis::LabelledPicture& picture) {
  if (std::min(picture.image.height(), picture.image.width()) >= engine::kSlopeSmallestSide) return;
  throw FileError(picture.name + ": has " + std::to_string(picture.image.width()) + " x " +
                  std::to_string(picture.image.height()) + " px; give pictures of at least " +
                  std::to_string(engine::kSlopeSmallestSide) + " px on each side");
}

int measure(const MeasureArguments& arguments) {
  const MeasureJob job = read_inputs(arguments);
  for (const analysis::LabelledPicture& picture : job.pictures) refuse_too_small(picture);
  engine::ExtractionOptions method;
  engine::RenderingOptions rendering;
  if (job.rules) {
    method = job.rules->methods.front();
    rendering = job.rules->rendering;
  }
  const analysis::MeasuredPictures measures =
      analysis::measure_pictures(job.pictures, method, rendering, progress_bar("measuring"));
  print(arguments.json ? analysis::measures_json(measures) : analysis::measures_text(measures));
  return 0;
}

}  // namespace

void add_stimuli_measure_command(CLI::App& stimuli, Action& action) {
  auto arguments = std::make_shared<MeasureArguments>();
  CLI::App* command = stimuli.add_subcommand(
      "measure", "Measure pictures: co-occurrence, spectrum, similarity, force");
  command
      ->add_option("STUDY|IMAGE|FOLDER", arguments->inputs,
                   "Study files, pictures (each a class), or folders of pictures (folders in a "
                   "folder are classes)")
      ->required()
      ->check(CLI::ExistingPath);
  command
      ->add_option("--photographs", arguments->photographs, "Folder of photographs to compare with")
      ->check(CLI::ExistingDirectory);
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return measure(*arguments); }; });
}

}  // namespace touchtrial::app
