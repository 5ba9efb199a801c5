// prepare: makes the force fields and the key of a study. Its output does not link a stimulus to
// its code.
#include "analysis/planning/level_report.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/prepared_secrets.hpp"
#include "app/commands/shipped_files.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "app/terminal/passphrases.hpp"
#include "study/prepare.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json statistics_json(const engine::FieldStatistics& statistics) {
  return {{"tangential_rms_n", statistics.tangential_rms_n},
          {"tangential_p999_n", statistics.tangential_p999_n},
          {"normal_rms_n", statistics.normal_rms_n},
          {"stiffness_p99_n_per_mm", statistics.stiffness_p99_n_per_mm},
          {"share_below_1_mm", statistics.share_below_1_mm},
          {"share_above_250_hz", statistics.share_above_250_hz}};
}

Json stimulus_json(const study::PreparedStimulus& stimulus) {
  return {{"class", stimulus.class_label},
          {"exemplar", stimulus.exemplar + 1},
          {"method", stimulus.method},
          {"state", stimulus.reused ? "reused" : "built"},
          {"seconds", stimulus.seconds},
          {"bytes", stimulus.bytes},
          {"gains",
           {{"tangential_n", stimulus.gains.tangential_n},
            {"normal_n", stimulus.gains.normal_n},
            {"height_mm", stimulus.gains.height_mm}}},
          {"statistics", statistics_json(stimulus.statistics)}};
}

// Limits of the side of a plane that a hand can stroke with the forearm at rest.
constexpr double kMinPlaneMm = 20.0;
constexpr double kMaxPlaneMm = 250.0;

/// \return a remark on an unsuitable size of the plane; otherwise empty
std::string remark_on(const PlaneGeometry& plane) {
  if (std::min(plane.width_mm(), plane.height_mm()) < kMinPlaneMm) {
    return fmt::format(
        "too small to be stroked, below {:g} mm: take larger pictures, or raise "
        "/rendering/pitch_mm",
        kMinPlaneMm);
  }
  if (std::max(plane.width_mm(), plane.height_mm()) > kMaxPlaneMm) {
    return fmt::format(
        "larger than a hand reaches, above {:g} mm: crop the pictures with `touchtrial stimuli "
        "import`, or lower /rendering/pitch_mm",
        kMaxPlaneMm);
  }
  return "";
}

std::string plane_text(const PlaneGeometry& plane) {
  const std::string remark = remark_on(plane);
  return fmt::format("plane    {:.6g} x {:.6g} mm, {} x {} pixels of {:g} mm{}\n", plane.width_mm(),
                     plane.height_mm(), plane.width_px, plane.height_px, plane.pitch_mm,
                     remark.empty() ? "" : ": " + remark);
}

/// The levels of a prepared stimulus, by its class, exemplar and method.
const simulation::PlaneLevels& levels_of(const study::PreparedStimulus& stimulus,
                                         const study::Study& study,
                                         const simulation::StimulusLevels& levels) {
  std::size_t place = 0;
  for (std::size_t i = 0; i < levels.stimuli.size(); ++i) {
    const study::StimulusIndex& index = levels.stimuli[i];
    if (study.classes[index.class_index].label == stimulus.class_label &&
        index.exemplar == stimulus.exemplar &&
        study.methods[index.method].label == stimulus.method) {
      place = i;
    }
  }
  return levels.levels[place];
}

/// The whole report. Fields: docs/data-dictionary.md, "What `prepare` did".
std::string prepare_json(const study::PrepareReport& report, const study::PackPlace& place,
                         const PlaneGeometry& plane, const study::Study& study,
                         const simulation::StimulusLevels& levels) {
  Json stimuli = Json::array();
  for (const study::PreparedStimulus& stimulus : report.stimuli) {
    stimuli.push_back(stimulus_json(stimulus));
    stimuli.back()["levels"] =
        Json::parse(planning::levels_json(levels_of(stimulus, study, levels)));
  }
  Json practice = Json::array();
  for (const study::PreparedStimulus& stimulus : report.practice) {
    practice.push_back(stimulus_json(stimulus));
  }
  Json skipped = Json::array();
  for (const study::SkippedWork& work : report.skipped) {
    skipped.push_back({{"what", work.what}, {"why", work.why}, {"bytes", work.bytes}});
  }
  const Json object = {{"pack", place.pack.string()},
                       {"key", place.key.string()},
                       {"plane",
                        {{"width_mm", plane.width_mm()},
                         {"height_mm", plane.height_mm()},
                         {"remark", remark_on(plane)}}},
                       {"stimuli", stimuli},
                       {"practice", practice},
                       {"blank", {{"levels", Json::parse(planning::levels_json(levels.blank))}}},
                       {"provisional", levels.provisional},
                       {"differences", Json::parse(planning::differences_json(study, levels))},
                       {"skipped", skipped},
                       {"warnings", report.warnings}};
  return json_text(object);
}

struct PrepareArguments {
  fs::path study;
  fs::path pack;
  bool json = false;
  bool passphrase = false;
};

std::string stimulus_row(const study::PreparedStimulus& stimulus, std::size_t method_width) {
  const engine::FieldStatistics& statistics = stimulus.statistics;
  return fmt::format(
      "{:<16} {:>8} {:<{}} {:<7} {:>9.4f} {:>9.4f} {:>9.3f} {:>7.1f} % {:>6.1f} {:>6.1f} "
      "{:>6.1f}\n",
      stimulus.class_label, stimulus.exemplar + 1, stimulus.method, method_width,
      stimulus.reused ? "reused" : "built", statistics.tangential_rms_n,
      statistics.tangential_p999_n, statistics.stiffness_p99_n_per_mm,
      100 * statistics.share_below_1_mm, 100 * statistics.share_above_250_hz[0],
      100 * statistics.share_above_250_hz[1], 100 * statistics.share_above_250_hz[2]);
}

std::string table_of(const study::PrepareReport& report) {
  std::size_t width = 10;
  for (const study::PreparedStimulus& stimulus : report.stimuli) {
    width = std::max(width, stimulus.method.size());
  }
  std::string text = fmt::format(
      "{:<16} {:>8} {:<{}} {:<7} {:>9} {:>9} {:>9} {:>9} {:>20}\n{:<16} {:>8} {:<{}} {:<7} {:>9} "
      "{:>9} {:>9} {:>9} {:>6} {:>6} {:>6}\n",
      "", "", "", width, "", "rms", "99.9th", "stiffness", "under", "% over 250 Hz at", "class",
      "exemplar", "method", width, "", "force N", "force N", "N/mm", "1 mm", "50", "100",
      "200 mm/s");
  for (const study::PreparedStimulus& stimulus : report.stimuli)
    text += stimulus_row(stimulus, width);
  if (!report.practice.empty()) text += "practice:\n";
  for (const study::PreparedStimulus& stimulus : report.practice)
    text += stimulus_row(stimulus, width);
  return text;
}

/// One line, because all stimuli of a study share their gains unless they are equalised.
std::string gains_of(const study::PrepareReport& report, engine::ModelKind model) {
  if (report.stimuli.empty()) return "";
  const engine::Gains first = report.stimuli.front().gains;
  const bool are_shared =
      std::all_of(report.stimuli.begin(), report.stimuli.end(),
                  [&](const study::PreparedStimulus& s) { return s.gains == first; });
  if (!are_shared) return "gains: one for each stimulus, so that all are equally strong\n";
  if (model == engine::ModelKind::surface) {
    return fmt::format("gain: height {:.6g} mm per grey level; forces at a load of {} N\n",
                       first.height_mm, engine::kReferenceLoadN);
  }
  return fmt::format(
      "gains: tangential {:.6g} N per grey level and pixel, normal {:.6g} N per grey level\n",
      first.tangential_n, first.normal_n);
}

std::string line_of_totals(const study::PrepareReport& report) {
  std::ptrdiff_t reused = 0;
  std::ptrdiff_t total = 0;
  for (const auto* const list : {&report.stimuli, &report.practice}) {
    reused += std::ranges::count(*list, true, &study::PreparedStimulus::reused);
    total += std::ssize(*list);
  }
  std::string text = fmt::format("built {}, reused {}", total - reused, reused);
  for (const study::SkippedWork& skipped : report.skipped) {
    text += fmt::format("\nskipped {}: {}", skipped.what, skipped.why);
  }
  return text + "\n";
}

/// The levels without their warnings, which are printed separately.
std::string levels_text(const study::Study& study, const simulation::StimulusLevels& levels) {
  analysis::Document document;
  document.sections.push_back(planning::levels_section(study, levels));
  std::erase_if(document.sections.front().blocks, [](const analysis::Block& block) {
    return std::holds_alternative<analysis::Warnings>(block);
  });
  return analysis::document_text(document, columns_of_output()) + "\n";
}

/// The paths and purposes of all files.
std::string places_text(const study::StudyKey& key, const study::PackPlace& place) {
  std::string text = fmt::format("pack     {}\n", place.pack.string());
  for (const study::Station& station : key.stations) {
    text +=
        fmt::format("station  {} (for `touchtrial run`)\n", place.station(station.name).string());
  }
  return text + fmt::format(
                    "key      {} (the investigator's; opens every session: move it to another "
                    "medium before the first participant)\n",
                    place.key.string());
}

int prepare(const PrepareArguments& arguments) {
  if (arguments.pack.empty()) refuse_installed_study(arguments.study);
  const study::Study study = study::load_study(arguments.study);
  study::check_images_exist(study);
  static_cast<void>(simulation::level_devices(study));  // throws if the device does not exist
  const PlaneGeometry plane = study::plane_of(study);
  const study::PackPlace place = pack_place_for(arguments.study, arguments.pack);
  study::PackLock lock(place.pack);
  lock.lock_key(place.key);
  PreparedSecrets secrets(study, place, arguments.passphrase);
  const study::StudyKey& key = secrets.key();
  study::PrepareReport report = prepare_with_progress(
      lock, key,
      {.publish_secrets = [&secrets] { secrets.publish(); }, .is_new_key = secrets.is_new()});
  const simulation::StimulusLevels levels = levels_of_pack(key);
  for (std::string& warning : planning::level_warnings(study, levels)) {
    report.warnings.push_back(std::move(warning));
  }
  for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
  if (arguments.json) {
    print(prepare_json(report, place, plane, study, levels));
    return 0;
  }
  print(table_of(report) + gains_of(report, study.rendering.model) + levels_text(study, levels) +
        line_of_totals(report) + plane_text(plane) + places_text(key, place));
  return 0;
}

}  // namespace

void add_prepare_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "prepare",
      "Make the force fields and the key of a study if they are missing or outdated", prepare);
  add_study_argument(command, arguments.study);
  command.add_option("--pack", arguments.pack,
                     "Folder of the pack; the key is beside it (default: <study>.pack)");
  command.add_flag("--passphrase", arguments.passphrase,
                   "Protect the key with a passphrase, from a prompt or the first line of "
                   "--passphrase-file");
  add_passphrase_option(command);
  add_json_flag(command, arguments.json);
}

}  // namespace touchtrial::app
