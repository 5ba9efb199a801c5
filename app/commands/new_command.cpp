// new: asks a few questions and writes a runnable study, with a comment at every key.
#include "app/commands/commands.hpp"
#include "app/commands/given_pictures.hpp"
#include "app/commands/made_folder.hpp"
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
/// By option, for instance "--people".
using Answers = std::map<std::string, std::string>;

/// A question that is asked unless its option is given.
struct NewQuestion {
  std::string option;
  std::string text;
  CLI::Validator allowed;
  std::function<std::string(const Answers&)> default_value;  ///< the default, for Return and --yes
  bool (*is_asked)(const Answers&) = [](const Answers&) { return true; };
};

struct NewArguments {
  fs::path folder;
  Answers answers;
  int size_px = 0;  ///< 0: size_for the device
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
  const bool has_edge = !text.empty() && (text.front() == ' ' || text.back() == ' ');
  return text.size() <= 64 && !has_edge && one_line(text) == text;
}

/// Returns an answer that `is_allowed`, or throws the message.
template <typename IsAllowed>
CLI::Validator allowed_if(IsAllowed is_allowed, const std::string& message,
                          const std::string& kind) {
  return {[=](const std::string& text) { return is_allowed(text) ? std::string() : message; },
          kind};
}

template <typename Number>
CLI::Validator number_within(Number low, Number high) {
  return allowed_if(
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

std::vector<std::string> groups_in(const std::string& text) {
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

bool are_groups(const std::string& text) {
  const std::vector<std::string> groups = groups_in(text);
  const std::set<std::string> different(groups.begin(), groups.end());
  return groups.empty() ||
         (groups.size() >= 2 && groups.size() <= kMaxGroups && different.size() == groups.size() &&
          std::ranges::all_of(groups, is_plain_name));
}

std::vector<NewQuestion> new_questions() {
  const auto always = [](std::string answer) {
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
       allowed_if(is_plain_name, "must have 1 to 64 of the characters 0-9 A-Z a-z _ -", "NAME"),
       always(kDefaultName)},
      {"--protocol",
       "Protocol: " + listed(protocols, " or ") +
           "; for thresholds, copy a ready study with touchtrial examples",
       CLI::IsMember(protocols), always(protocols.front())},
      {"--device",
       "Device that the study is for, such as touch or omega; empty: none, and simulated people "
       "hold an ideal device",
       allowed_if(
           is_device,
           "must be one of " + listed(devices, " or ") + "; a model's file is named in the study",
           "NAME"),
       always("")},
      {"--pictures", "Folder of your photographs; empty: five of the program's textures",
       allowed_if(is_folder, "is not a folder; check the path", "FOLDER"), always("")},
      {"--people", "Number of participants", number_within(2, 100'000), always("20")},
      {"--worth",
       "Smallest relevant effect, percentage points: right answers above chance, or of one method "
       "above another",
       number_within(1.0, 50.0),
       [](const Answers& answers) { return methods_of(answers) > 1 ? "10" : "20"; }},
      {"--language", "Language of the participants: " + listed(languages, " or "),
       CLI::IsMember(languages), always(languages.front())},
      {"--consent", "Version of the consent form; empty: none",
       allowed_if(is_version, "must be at most 64 bytes without blanks at its ends", "VERSION"),
       always("")},
      {"--visits", "Visits of each participant", number_within(1, 100), always("1")},
      {"--between", "Minimum days between two visits", number_within(0.0, 3650.0), always("7"),
       [](const Answers& answers) { return visits_of(answers) > 1; }},
      {"--groups", "Groups that participants are assigned to, such as trained,control; empty: none",
       allowed_if(are_groups, "must be 2 to 16 names of 0-9 A-Z a-z _ - with commas between them",
                  "NAMES"),
       always("")},
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
      throw UsageError("new: there is no answer for " + question.option +
                       "; nothing was written: answer the questions, or give --yes for the usual "
                       "answers");
    }
    if (line.empty()) return default_value;
    const std::string wrong = question.allowed(line);
    if (wrong.empty()) return line;
    std::fputs((one_line(line + ": " + wrong) + "\n").c_str(), stderr);
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

/// Asks for another size and number of crops that the photographs can provide.
void ask_crops(NewArguments& arguments, const stimuli::CropsDoNotFit& now) {
  const auto answer = [](const char* option, const char* text, int low, int high,
                         int default_value) {
    const NewQuestion question{option, text, number_within(low, high), {}};
    return *number_in<int>(typed_answer(question, std::to_string(default_value)));
  };
  arguments.size_px =
      answer("--size", "Side of a picture, pixels", stimuli::kMinCropSizePx,
             stimuli::kMaxCropSizePx, now.size_px() > 0 ? now.size_px() : arguments.size_px);
  arguments.crops = answer("--crops", "Crops of the photographs of each texture", 1,
                           stimuli::kMaxCropsOfClass, arguments.crops);
}

/// Checks the photographs before further questions. If they are too small, asks for the size and
/// number of crops; if they are unusable, for another folder.
/// \param question  "--pictures"
/// \param typed  the folder was typed as an answer; an unusable folder from an option is refused
void try_pictures(NewArguments& arguments, const NewQuestion& question, bool typed) {
  std::string& folder = arguments.answers.at(question.option);
  while (!folder.empty()) {
    try {
      return naming_faults(
          [&] { stimuli::try_photographs(import_options(arguments), progress_bar("reading")); });
    } catch (const stimuli::CropsDoNotFit& small) {
      if (arguments.yes) throw;
      std::fputs((one_line(small.what()) + "\n").c_str(), stderr);
      const bool smaller_suffices = small.size_px() > 0 || small.crops() > 0;
      if (smaller_suffices) {
        ask_crops(arguments, small);
      } else if (typed) {
        folder = typed_answer(question, "");
      } else {
        throw;
      }
    } catch (const FileError& wrong) {
      if (!typed || arguments.yes) throw;
      std::fputs((one_line(wrong.what()) + "\n").c_str(), stderr);
      folder = typed_answer(question, "");
    }
  }
}

/// \return the default size of pictures, pixels: of those whose plane the device reaches, in tens
/// \param device  "" : none
int size_for(const std::string& device) {
  constexpr int kDefaultSide = stimuli::kDefaultStimulusSizePx;
  if (device.empty()) return kDefaultSide;
  const PlaneGeometry default_plane{engine::RenderingOptions{}.pitch_mm, kDefaultSide,
                                    kDefaultSide};
  const PlaneGeometry fits =
      device::fit_plane(default_plane, device::model_of_device(device).workspace).largest;
  const int side = std::min(fits.width_px, fits.height_px);
  return std::max(side == kDefaultSide ? side : side / 10 * 10, stimuli::kMinCropSizePx);
}

/// Asks the questions without options. The default name is the folder's.
void interview(NewArguments& arguments) {
  const fs::path& given = arguments.folder;
  const std::string folder =
      (given.has_filename() ? given : given.parent_path()).filename().string();
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
    if (question.option == "--pictures") try_pictures(arguments, question, !is_given);
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
  const stimuli::StimulusManifest made = stimuli::generate_default_stimuli(
      study.file.parent_path() / folder, {.size_px = size_px, .exemplars = 1, .kind = kind},
      progress_bar("generating"));
  Json classes = Json::array();
  for (const stimuli::StimulusEntry& entry : made.entries) {
    classes.push_back(
        {{"label", entry.label}, {"images", {(folder / entry.file).generic_string()}}});
  }
  return classes;
}

void import_pictures(const NewArguments& arguments, NewStudy& study) {
  stimuli::ImportOptions options = import_options(arguments);
  options.study = study.file;
  const stimuli::ImportReport report = naming_faults(
      [&] { return stimuli::import_photographs(options, progress_bar("importing")); });
  for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
  const Json imported = Json::parse(text_of(read_file(study.file)));
  study.classes = imported.at("classes");
  study.seed = imported.at("seed").get<std::uint64_t>();
}

/// Whether a class has a label that looks like `label`.
bool has_label(const Json& classes, const std::string& label) {
  return std::ranges::any_of(classes, [&](const Json& one) {
    return skeleton_of(one.at("label").get<std::string>()) == skeleton_of(label);
  });
}

/// Practice textures have the classes' size. Without practice if fewer than two have labels that
/// the study does not use.
void add_practice(NewStudy& study, int size_px) {
  for (const Json& one :
       generated_classes(study, ".practice", stimuli::StimulusKind::practice, size_px)) {
    if (!has_label(study.classes, one.at("label").get<std::string>()))
      study.practice.push_back(one);
  }
  if (study.practice.size() < 2) study.practice.clear();
}

/// The list's entries, one a line.
std::string lines_of(const Json& list, const std::string& indent) {
  std::string text;
  for (const Json& entry : list) text += (text.empty() ? "" : ",\n" + indent) + entry.dump();
  return text;
}

using Fillings = std::map<std::string, std::string, std::less<>>;

/// A line of the template with names in braces replaced by values.
std::string filled_line(std::string_view line, const Fillings& fillings) {
  std::string filled;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t end = line[at] == '{' ? line.find('}', at) : line.npos;
    const auto found =
        end == line.npos ? fillings.end() : fillings.find(line.substr(at + 1, end - at - 1));
    if (found == fillings.end()) {
      filled += line[at++];
    } else {
      filled += found->second;
      at = end + 1;
    }
  }
  return filled + "\n";
}

/// The template of new_study.json.in. Lines between "#if NAME" and "#else" or "#end" are included
/// if NAME has a value, those between "#else" and "#end" if it has none.
std::string filled_in(const std::string& text, const Fillings& fillings) {
  std::string filled;
  std::istringstream lines(text);
  bool is_kept = true;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#if ")) {
      is_kept = fillings.contains(std::string_view(line).substr(4));
    } else if (line == "#else") {
      is_kept = !is_kept;
    } else if (line == "#end") {
      is_kept = true;
    } else if (is_kept) {
      filled += filled_line(line, fillings);
    }
  }
  return filled;
}

std::string in_json(const std::string& text) {
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
  Fillings fillings = {{"name", in_json(answers.at("--name"))},
                       {"protocol", in_json(answers.at("--protocol"))},
                       {"classes", lines_of(study.classes, "    ")},
                       {"number_of_classes", std::to_string(study.classes.size())},
                       {"language", in_json(answers.at("--language"))},
                       {"consent", in_json(answers.at("--consent"))},
                       {"people", std::to_string(*number_in<int>(answers.at("--people")))},
                       {"worth", fmt::format("{:g}", *number_in<double>(answers.at("--worth")))},
                       {"effect", number_text(effect_of(arguments, study.classes.size()))},
                       {"visits", std::to_string(visits_of(answers))},
                       {"seed", std::to_string(study.seed)}};
  if (methods_of(answers) > 1) fillings["compares"] = "";
  if (!answers.at("--device").empty()) fillings["device"] = in_json(answers.at("--device"));
  if (!study.practice.empty()) fillings["practice"] = lines_of(study.practice, "      ");
  if (const auto groups = groups_in(answers.at("--groups")); !groups.empty()) {
    fillings["groups"] = Json(groups).dump();
  }
  if (visits_of(answers) > 1) {
    fillings["several_visits"] = "";
    fillings["between"] = number_text(*number_in<double>(answers.at("--between")));
  }
  return filled_in(new_study_template(), fillings);
}

std::string next_steps(const NewArguments& arguments, const NewStudy& study) {
  const std::string file = shell_word(study.file.string());
  return fmt::format(
      "study    {}\npictures {}\n\nLook at its screens, make its forces and its key, and rehearse "
      "it with simulated people:\n\n  touchtrial preview {}\n  touchtrial prepare {}\n  touchtrial "
      "simulate {} --participants {} --db {}\n",
      study.file.string(), stimuli::default_pictures_folder(study.file).string(), file, file, file,
      arguments.answers.at("--people"),
      shell_word((study.file.parent_path() / "rehearsal.db").string()));
}

int write_new_study(const NewArguments& given) {
  NewArguments arguments = given;
  if (!arguments.folder.empty()) require_free(arguments.folder);
  interview(arguments);
  const std::string& name = arguments.answers.at("--name");
  const fs::path folder = arguments.folder.empty() ? fs::path(name) : arguments.folder;
  require_free(folder);
  MadeFolder made(folder);
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
  made.keep();
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
        ->check(question.allowed);
  }
  add_count_option(
      command, "--size", arguments.size_px,
      "Side of a picture, pixels; one is 0.2 mm (default: 500, or what the device reaches)",
      stimuli::kMinCropSizePx, stimuli::kMaxCropSizePx);
  add_count_option(command, "--crops", arguments.crops, "Crops of the photographs of each texture",
                   1, stimuli::kMaxCropsOfClass);
  add_sample_options(command, arguments.scale);
  command.add_flag("--yes", arguments.yes, "Use the default answers without asking");
}

}  // namespace touchtrial::app
