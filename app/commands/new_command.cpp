// new: asks a few questions and writes a runnable study, with a comment at every key.
#include "app/commands/commands.hpp"
#include "app/commands/input_pictures.hpp"
#include "app/commands/new_folder.hpp"
#include "app/commands/new_study_template.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "core/plane_geometry.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "device/drivers/registry.hpp"
#include "device/model/workspace_fit.hpp"
#include "engine/rendering/rendering_options.hpp"
#include "stimuli/default_set.hpp"
#include "stimuli/import/import.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
/// The answers by option, for instance "--people".
using Answers = std::map<std::string, std::string>;

/// A question that is asked unless its option is given.
struct NewQuestion {
  std::string option;
  std::string text;
  CLI::Validator validator;
  std::function<std::string(const Answers&)> default_value;  ///< the default, for Return and --yes
  bool (*is_asked)(const Answers&) = [](const Answers&) { return true; };
};

struct NewArguments {
  fs::path folder;
  Answers answers;
  int size_px = 0;  ///< 0: the size that size_for returns for the device
  int crops = 5;
  engine::SampleScale scale;
  bool yes = false;
};

constexpr const char* kDefaultName = "my-study";
constexpr std::size_t kMaxGroups = 16;

bool is_plain_name(std::string_view name) {
  const auto is_plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, is_plain);
}

bool is_version(const std::string& text) {
  const bool has_outer_blank = !text.empty() && (text.front() == ' ' || text.back() == ' ');
  return text.size() <= 64 && !has_outer_blank && one_line(text) == text;
}

/// A validator that refuses other answers with the message.
template <typename IsAllowed>
CLI::Validator validator_for(IsAllowed is_allowed, const std::string& message,
                             const std::string& kind) {
  return {[=](const std::string& text) { return is_allowed(text) ? std::string() : message; },
          kind};
}

template <typename Number>
CLI::Validator number_validator(Number low, Number high) {
  return validator_for(
      [=](const std::string& text) {
        const auto number = number_in<Number>(text);
        return number && *number >= low && *number <= high;
      },
      fmt::format("must be a number from {} to {}", low, high), "NUMBER");
}

int methods_of(const Answers& answers) {
  return study::find_protocol(answers.at("--protocol"))->min_methods;
}

int visits_of(const Answers& answers) {
  return *number_in<int>(answers.at("--visits"));
}

std::vector<std::string> parse_groups(const std::string& text) {
  std::vector<std::string> groups;
  std::istringstream names(text);
  for (std::string name; std::getline(names, name, ',');) {
    const std::size_t begin = name.find_first_not_of(' ');
    groups.push_back(begin == std::string::npos
                         ? ""
                         : name.substr(begin, name.find_last_not_of(' ') + 1 - begin));
  }
  return groups;
}

bool is_group_list(const std::string& text) {
  const std::vector<std::string> groups = parse_groups(text);
  const std::set<std::string> unique_groups(groups.begin(), groups.end());
  return groups.empty() ||
         (groups.size() >= 2 && groups.size() <= kMaxGroups &&
          unique_groups.size() == groups.size() && std::ranges::all_of(groups, is_plain_name));
}

std::vector<NewQuestion> new_questions() {
  const auto constant = [](std::string answer) {
    return [answer = std::move(answer)](const Answers&) { return answer; };
  };
  const std::vector<std::string> protocols = protocols_of_new_studies();
  const std::vector<std::string> languages(study::language_codes().begin(),
                                           study::language_codes().end());
  const std::vector<std::string> devices = device::modelled_names();
  const auto is_device = [devices](const std::string& text) {
    return text.empty() || std::ranges::find(devices, text) != devices.end();
  };
  const auto is_folder = [](const std::string& text) {
    std::error_code unreadable;
    return text.empty() || fs::is_directory(text, unreadable);
  };
  return {
      {"--name", "Name of the study",
       validator_for(is_plain_name, "must have 1 to 64 of the characters 0-9 A-Z a-z _ -", "NAME"),
       constant(kDefaultName)},
      {"--protocol",
       "Protocol: " + listed(protocols, " or ") +
           "; for thresholds, copy an example study with touchtrial examples",
       CLI::IsMember(protocols), constant(protocols.front())},
      {"--device",
       "Device of the study, such as touch or omega; empty: none, and simulated people hold an "
       "ideal device",
       validator_for(is_device,
                     "must be one of " + listed(devices, " or ") +
                         "; to use a model file, name it in the study file",
                     "NAME"),
       constant("")},
      {"--pictures", "Folder of your photographs; empty: five built-in textures",
       validator_for(is_folder, "is not a folder; check the path", "FOLDER"), constant("")},
      {"--people", "Number of participants", number_validator(2, 100'000), constant("20")},
      {"--worth",
       "Smallest relevant effect, percentage points: right answers above chance, or the difference "
       "between methods",
       number_validator(1.0, 50.0),
       [](const Answers& answers) { return methods_of(answers) > 1 ? "10" : "20"; }},
      {"--language", "Language of the participants: " + listed(languages, " or "),
       CLI::IsMember(languages), constant(languages.front())},
      {"--consent", "Version of the consent form; empty: none",
       validator_for(is_version, "must be at most 64 bytes without blanks at its ends", "VERSION"),
       constant("")},
      {"--visits", "Visits of each participant", number_validator(1, 100), constant("1")},
      {"--between", "Minimum days between two visits", number_validator(0.0, 3650.0), constant("7"),
       [](const Answers& answers) { return visits_of(answers) > 1; }},
      {"--groups", "Groups that participants are assigned to, such as trained,control; empty: none",
       validator_for(is_group_list,
                     "must be 2 to 16 names of 0-9 A-Z a-z _ - with commas between them", "NAMES"),
       constant("")},
  };
}

std::string typed_answer(const NewQuestion& question, const std::string& default_value) {
  for (;;) {
    const std::string prompt =
        question.text + (default_value.empty() ? ": " : " [" + default_value + "]: ");
    std::fputs(prompt.c_str(), stderr);
    std::string line;
    if (!std::getline(std::cin, line)) {
      std::fputs("\n", stderr);
      throw UsageError("new: the input ended before the answer to " + question.option +
                       "; nothing was written: answer the questions, or give --yes for the "
                       "default answers");
    }
    if (line.empty()) return default_value;
    const std::string message = question.validator(line);
    if (message.empty()) return line;
    std::fputs((one_line(line + ": " + message) + "\n").c_str(), stderr);
  }
}

stimuli::ImportOptions import_options(const NewArguments& arguments) {
  stimuli::ImportOptions options;
  options.photographs = arguments.answers.at("--pictures");
  options.size_px = arguments.size_px;
  options.crops = arguments.crops;
  options.scale = arguments.scale;
  options.protocol = arguments.answers.at("--protocol");
  options.methods = methods_of(arguments.answers);
  return options;
}

/// Asks for a size and a number of crops that the photographs can provide.
void ask_crops(NewArguments& arguments, const stimuli::CropsDoNotFit& error) {
  const auto answer = [](const char* option, const char* text, int low, int high,
                         int default_value) {
    const NewQuestion question{option, text, number_validator(low, high), {}};
    return *number_in<int>(typed_answer(question, std::to_string(default_value)));
  };
  arguments.size_px =
      answer("--size", "Side of a picture, pixels", stimuli::kMinCropSizePx,
             stimuli::kMaxCropSizePx, error.size_px() > 0 ? error.size_px() : arguments.size_px);
  arguments.crops = answer("--crops", "Crops of the photographs of each texture", 1,
                           stimuli::kMaxCropsOfClass, arguments.crops);
}

/// Checks the photographs before further questions. If they are too small, asks for the size and
/// number of crops; if they are unusable, for another folder.
/// \param question  "--pictures"
/// \param is_typed  whether the folder was an answer; an unusable folder from an option is refused
void check_pictures(NewArguments& arguments, const NewQuestion& question, bool is_typed) {
  std::string& folder = arguments.answers.at(question.option);
  while (!folder.empty()) {
    try {
      return with_faults_printed(
          [&] { stimuli::try_photographs(import_options(arguments), progress_bar("reading")); });
    } catch (const stimuli::CropsDoNotFit& error) {
      if (arguments.yes) throw;
      std::fputs((one_line(error.what()) + "\n").c_str(), stderr);
      const bool smaller_suffices = error.size_px() > 0 || error.crops() > 0;
      if (smaller_suffices) {
        ask_crops(arguments, error);
      } else if (is_typed) {
        folder = typed_answer(question, "");
      } else {
        throw;
      }
    } catch (const FileError& error) {
      if (!is_typed || arguments.yes) throw;
      std::fputs((one_line(error.what()) + "\n").c_str(), stderr);
      folder = typed_answer(question, "");
    }
  }
}

/// \return the default size of pictures, pixels: limited to a plane that the device can reach
/// \param device  empty: none
int size_for(const std::string& device) {
  constexpr int kDefaultSide = stimuli::kDefaultStimulusSizePx;
  if (device.empty()) return kDefaultSide;
  const PlaneGeometry default_plane{engine::RenderingOptions{}.pitch_mm, kDefaultSide,
                                    kDefaultSide};
  const PlaneGeometry largest_plane =
      device::fit_plane(default_plane, device::model_of_device(device).workspace).largest;
  const int side = std::min(largest_plane.width_px, largest_plane.height_px);
  return std::max(side == kDefaultSide ? side : side / 10 * 10, stimuli::kMinCropSizePx);
}

/// Asks the questions whose options are not given. The default name is the folder's.
void ask_questions(NewArguments& arguments) {
  const fs::path& path = arguments.folder;
  const std::string folder = (path.has_filename() ? path : path.parent_path()).filename().string();
  for (const NewQuestion& question : new_questions()) {
    const bool is_given = arguments.answers.contains(question.option);
    if (!is_given) {
      std::string default_value = question.default_value(arguments.answers);
      if (question.option == "--name" && is_plain_name(folder)) default_value = folder;
      const bool is_asked = !arguments.yes && question.is_asked(arguments.answers);
      arguments.answers[question.option] =
          is_asked ? typed_answer(question, default_value) : default_value;
    }
    if (question.option == "--device" && arguments.size_px == 0) {
      arguments.size_px = size_for(arguments.answers.at(question.option));
    }
    if (question.option == "--pictures") check_pictures(arguments, question, !is_given);
  }
}

/// The new study file, and the files beside it.
struct NewStudy {
  fs::path file;
  Json classes = Json::array();
  Json practice = Json::array();
  std::uint64_t seed = stimuli::kDefaultStimuliSeed;
};

/// Makes the default pictures of one kind beside the study.
Json generated_classes(const NewStudy& study, const std::string& ending, stimuli::StimulusKind kind,
                       int size_px) {
  const fs::path folder = study.file.stem().string() + ending;
  const stimuli::StimulusManifest manifest = stimuli::generate_default_stimuli(
      study.file.parent_path() / folder, {.size_px = size_px, .exemplars = 1, .kind = kind},
      progress_bar("generating"));
  Json classes = Json::array();
  for (const stimuli::StimulusEntry& entry : manifest.entries) {
    classes.push_back(
        {{"label", entry.label}, {"images", {(folder / entry.file).generic_string()}}});
  }
  return classes;
}

void import_pictures(const NewArguments& arguments, NewStudy& study) {
  stimuli::ImportOptions options = import_options(arguments);
  options.study = study.file;
  const stimuli::ImportReport report = with_faults_printed(
      [&] { return stimuli::import_photographs(options, progress_bar("importing")); });
  for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
  const Json study_json = Json::parse(text_of(read_file(study.file)));
  study.classes = study_json.at("classes");
  study.seed = study_json.at("seed").get<std::uint64_t>();
}

/// Whether a class has a label that looks like `label`.
bool has_label(const Json& classes, const std::string& label) {
  return std::ranges::any_of(classes, [&](const Json& entry) {
    return skeleton_of(entry.at("label").get<std::string>()) == skeleton_of(label);
  });
}

/// Adds practice textures of the classes' size whose labels the study does not use; none if there
/// are fewer than two.
void add_practice(NewStudy& study, int size_px) {
  for (const Json& entry :
       generated_classes(study, ".practice", stimuli::StimulusKind::practice, size_px)) {
    if (!has_label(study.classes, entry.at("label").get<std::string>()))
      study.practice.push_back(entry);
  }
  if (study.practice.size() < 2) study.practice.clear();
}

/// The list's entries, one per line.
std::string lines_of(const Json& list, const std::string& indent) {
  std::string text;
  for (const Json& entry : list) text += (text.empty() ? "" : ",\n" + indent) + entry.dump();
  return text;
}

using Placeholders = std::map<std::string, std::string, std::less<>>;

/// A line of the template with the names in braces replaced by their values.
std::string expanded_line(std::string_view line, const Placeholders& placeholders) {
  std::string expansion;
  for (std::size_t position = 0; position < line.size();) {
    const std::size_t end = line[position] == '{' ? line.find('}', position) : line.npos;
    const auto placeholder = end == line.npos
                                 ? placeholders.end()
                                 : placeholders.find(line.substr(position + 1, end - position - 1));
    if (placeholder == placeholders.end()) {
      expansion += line[position++];
    } else {
      expansion += placeholder->second;
      position = end + 1;
    }
  }
  return expansion + "\n";
}

/// Expands the template new_study.json.in. Lines between "#if NAME" and "#else" or "#end" are
/// included if NAME has a value, lines between "#else" and "#end" if it has none.
std::string expanded_template(const std::string& text, const Placeholders& placeholders) {
  std::string expansion;
  std::istringstream lines(text);
  bool is_included = true;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#if ")) {
      is_included = placeholders.contains(std::string_view(line).substr(4));
    } else if (line == "#else") {
      is_included = !is_included;
    } else if (line == "#end") {
      is_included = true;
    } else if (is_included) {
      expansion += expanded_line(line, placeholders);
    }
  }
  return expansion;
}

std::string json_string(const std::string& text) {
  return Json(text).dump();
}

/// The smallest relevant effect, as a share of right answers or a difference of methods.
double effect_of(const NewArguments& arguments, std::size_t classes) {
  const double points = *number_in<double>(arguments.answers.at("--worth"));
  if (methods_of(arguments.answers) > 1) return points / 100.0;
  const double chance = 1.0 / static_cast<double>(classes);
  return std::min(1.0, std::round(1000.0 * chance + 10.0 * points) / 1000.0);
}

std::string study_text(const NewArguments& arguments, const NewStudy& study) {
  const Answers& answers = arguments.answers;
  Placeholders placeholders = {
      {"name", json_string(answers.at("--name"))},
      {"protocol", json_string(answers.at("--protocol"))},
      {"classes", lines_of(study.classes, "    ")},
      {"number_of_classes", std::to_string(study.classes.size())},
      {"language", json_string(answers.at("--language"))},
      {"consent", json_string(answers.at("--consent"))},
      {"people", std::to_string(*number_in<int>(answers.at("--people")))},
      {"worth", fmt::format("{:g}", *number_in<double>(answers.at("--worth")))},
      {"effect", number_text(effect_of(arguments, study.classes.size()))},
      {"visits", std::to_string(visits_of(answers))},
      {"seed", std::to_string(study.seed)}};
  if (methods_of(answers) > 1) placeholders["compares"] = "";
  if (!answers.at("--device").empty()) placeholders["device"] = json_string(answers.at("--device"));
  if (!study.practice.empty()) placeholders["practice"] = lines_of(study.practice, "      ");
  if (const auto groups = parse_groups(answers.at("--groups")); !groups.empty()) {
    placeholders["groups"] = Json(groups).dump();
  }
  if (visits_of(answers) > 1) {
    placeholders["several_visits"] = "";
    placeholders["between"] = number_text(*number_in<double>(answers.at("--between")));
  }
  return expanded_template(new_study_template(), placeholders);
}

std::string next_steps(const NewArguments& arguments, const NewStudy& study) {
  const std::string file = shell_word(study.file.string());
  return fmt::format(
      "study    {}\npictures {}\n\nPreview its screens, prepare its forces and its key, and "
      "rehearse "
      "it with simulated people:\n\n  touchtrial preview {}\n  touchtrial prepare {}\n  touchtrial "
      "simulate {} --participants {} --db {}\n",
      study.file.string(), stimuli::default_pictures_folder(study.file).string(), file, file, file,
      arguments.answers.at("--people"),
      shell_word((study.file.parent_path() / "rehearsal.db").string()));
}

int write_new_study(const NewArguments& initial) {
  NewArguments arguments = initial;
  if (!arguments.folder.empty()) require_free(arguments.folder);
  ask_questions(arguments);
  const std::string& name = arguments.answers.at("--name");
  const fs::path folder = arguments.folder.empty() ? fs::path(name) : arguments.folder;
  require_free(folder);
  NewFolder new_folder(folder);
  NewStudy study{.file = folder / (name + ".json")};
  if (arguments.answers.at("--pictures").empty()) {
    study.classes =
        generated_classes(study, ".pictures", stimuli::StimulusKind::texture, arguments.size_px);
  } else {
    import_pictures(arguments, study);
  }
  add_practice(study, arguments.size_px);
  write_output(study.file, study_text(arguments, study));
  static_cast<void>(study::load_study(study.file));
  new_folder.keep();
  print(next_steps(arguments, study));
  return 0;
}

}  // namespace

void add_new_command(CLI::App& program, Action& action) {
  const auto [command, arguments] =
      add_command(program, action, "new",
                  "Ask a few questions, and write a runnable study with pictures and comments",
                  write_new_study);
  command.add_option("FOLDER", arguments.folder, "Folder to create (default: the study's name)");
  for (const NewQuestion& question : new_questions()) {
    command
        .add_option_function<std::string>(
            question.option,
            [&answers = arguments.answers, option = question.option](const std::string& answer) {
              answers[option] = answer;
            },
            question.text)
        ->check(question.validator);
  }
  add_count_option(
      command, "--size", arguments.size_px,
      "Side of a picture, in pixels of 0.2 mm (default: 500, or less for a small workspace)",
      stimuli::kMinCropSizePx, stimuli::kMaxCropSizePx);
  add_count_option(command, "--crops", arguments.crops,
                   "Number of crops of each texture's photographs", 1, stimuli::kMaxCropsOfClass);
  add_sample_options(command, arguments.scale);
  command.add_flag("--yes", arguments.yes, "Use the default answers without asking");
}

}  // namespace touchtrial::app
