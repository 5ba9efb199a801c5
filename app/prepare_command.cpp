#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/prepare_explanation.hpp"
#include "core/cipher.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/loop_work_report.hpp"
#include "protocols/design/prepare.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PrepareArguments {
  fs::path study;
  fs::path pack;
  bool explain = false;
  bool json = false;
  bool loop_work = false;
};

/// A database that was sealed with the study as it was needs the key as it was.
void keep_earlier_key(const design::StudyKey& earlier, const fs::path& path) {
  constexpr std::size_t kSealDigits = 8;
  fs::path kept = path;
  kept += "." + to_hex(design::study_seal(earlier)).substr(0, kSealDigits);
  design::save_study_key(kept, earlier);
  spdlog::warn(
      "{}: the study has changed since; the earlier key, which databases sealed with it "
      "need, is kept as {}",
      path.string(), kept.string());
}

/// A study that was prepared before keeps its secrets, so that its codes and fields stay valid.
design::StudyKey key_for(const design::Study& study, const fs::path& path) {
  if (!is_there(path)) {
    SystemEntropy entropy;
    return design::make_study_key(study, entropy, false);
  }
  const design::StudyKey earlier = design::load_study_key(path);
  if (earlier.simulated) {
    throw UsageError(path.string() +
                     ": is the key of a simulated study; give another folder with --pack");
  }
  if (earlier.study.name != study.name) {
    throw UsageError(path.string() + ": is the key of study \"" + earlier.study.name +
                     "\"; give another folder with --pack");
  }
  design::StudyKey key = design::rekeyed(earlier, study);
  if (design::study_seal(key) != design::study_seal(earlier)) keep_earlier_key(earlier, path);
  return key;
}

std::string stimulus_row(const design::PreparedStimulus& stimulus, std::size_t method_width) {
  const engine::FieldStatistics& figures = stimulus.statistics;
  return fmt::format(
      "{:<16} {:>8} {:<{}} {:<7} {:>9.4f} {:>9.4f} {:>9.3f} {:>7.1f} % {:>6.1f} {:>6.1f} "
      "{:>6.1f}\n",
      stimulus.class_label, stimulus.exemplar + 1, stimulus.method, method_width,
      stimulus.reused ? "reused" : "built", figures.tangential_rms_n, figures.tangential_p999_n,
      figures.stiffness_p99_n_per_mm, 100 * figures.share_below_1_mm,
      100 * figures.share_above_250_hz[0], 100 * figures.share_above_250_hz[1],
      100 * figures.share_above_250_hz[2]);
}

std::string table_of(const design::PrepareReport& report) {
  std::size_t width = 10;
  for (const design::PreparedStimulus& stimulus : report.stimuli) {
    width = std::max(width, stimulus.method.size());
  }
  std::string text = fmt::format(
      "{:<16} {:>8} {:<{}} {:<7} {:>9} {:>9} {:>9} {:>9} {:>20}\n{:<16} {:>8} {:<{}} {:<7} {:>9} "
      "{:>9} {:>9} {:>9} {:>6} {:>6} {:>6}\n",
      "", "", "", width, "", "rms", "99.9th", "stiffness", "under", "% over 250 Hz at", "class",
      "exemplar", "method", width, "", "force N", "force N", "N/mm", "1 mm", "50", "100",
      "200 mm/s");
  for (const design::PreparedStimulus& stimulus : report.stimuli)
    text += stimulus_row(stimulus, width);
  return text;
}

/// One line where all stimuli share their gains, as they do unless they are equalised.
std::string gains_of(const design::PrepareReport& report, engine::ModelKind model) {
  if (report.stimuli.empty()) return "";
  const engine::Gains first = report.stimuli.front().gains;
  const bool shared =
      std::all_of(report.stimuli.begin(), report.stimuli.end(),
                  [&](const design::PreparedStimulus& s) { return s.gains == first; });
  if (!shared) return "gains: each stimulus has its own, so that all are equally strong\n";
  if (model == engine::ModelKind::surface) {
    return fmt::format("gain: height {:.6g} mm per grey level; forces at a load of {} N\n",
                       first.height_mm, engine::kStatedLoadN);
  }
  return fmt::format(
      "gains: tangential {:.6g} N per grey level and pixel, normal {:.6g} N per grey level\n",
      first.tangential_n, first.normal_n);
}

std::string line_of_totals(const design::PrepareReport& report) {
  const auto reused = std::count_if(report.stimuli.begin(), report.stimuli.end(),
                                    [](const design::PreparedStimulus& s) { return s.reused; });
  const auto total = static_cast<std::ptrdiff_t>(report.stimuli.size());
  std::string text = fmt::format("built {}, reused {}", total - reused, reused);
  for (const design::SkippedWork& skipped : report.skipped) {
    text += fmt::format("\nskipped {}: {}", skipped.what, skipped.why);
  }
  return text + "\n";
}

/// What a hand could gain by going in circles, under the study's model and the other.
std::string loop_work_table(const design::Study& study) {
  std::string text = fmt::format("\n{:<8} {:>6} {:>12} {:>12} {:>14} {:>14}\n", "model", "loops",
                                 "plane median", "plane worst", "press median", "press worst");
  for (const design::ModelLoopWork& work : design::loop_work_of(study)) {
    text += fmt::format("{:<8} {:>6} {:>9.2g} mJ {:>9.2g} mJ {:>11.2g} mJ {:>11.2g} mJ\n",
                        work.model == engine::ModelKind::paper ? "paper" : "surface",
                        work.loops_of_each_kind, work.planar.median_mj, work.planar.worst_mj,
                        work.press_slide_lift.median_mj, work.press_slide_lift.worst_mj);
  }
  return text + "work round closed loops: circles at a constant depth, and press, slide, lift\n";
}

int prepare(const PrepareArguments& arguments) {
  const design::Study study = design::load_study(arguments.study);
  design::check_images_exist(study);
  if (study.seed == 0) {
    spdlog::warn("{}: /seed is 0 or missing; give the study a seed of its own",
                 arguments.study.string());
  }
  const design::PackPlace place = arguments.pack.empty()
                                      ? design::default_pack_place(arguments.study)
                                      : design::pack_place_at(arguments.pack);
  design::StudyKey key = key_for(study, place.key);
  key.pack_folder = place.pack;
  design::save_study_key(place.key, key);
  const design::PrepareReport report = design::prepare_pack(
      key, place.pack, progress_bar("preparing"), {.explain = arguments.explain});
  for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
  if (arguments.json) {
    print(prepare_json(report, place));
    return 0;
  }
  print((arguments.explain ? explanation_text(report) + "\n" : "") + table_of(report) +
        gains_of(report, study.rendering.model) + line_of_totals(report) +
        fmt::format("pack {}\nkey  {} (keep it to yourself)\n", place.pack.string(),
                    place.key.string()));
  if (arguments.loop_work) print(loop_work_table(study));
  return 0;
}

}  // namespace

void add_prepare_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<PrepareArguments>();
  CLI::App* command = program.add_subcommand(
      "prepare", "Make a study's force fields and its key: only what is missing or changed");
  command->add_option("STUDY", arguments->study, "Study file")->required();
  command->add_option("--pack", arguments->pack,
                      "Folder of the pack; the key lies beside it (default: <study>.pack)");
  command->add_flag("--explain", arguments->explain,
                    "Say stage by stage what was computed, reused or skipped, why, and what it "
                    "cost");
  auto* json =
      command->add_flag("--json", arguments->json, "One JSON object in place of the tables");
  command
      ->add_flag("--loop-work", arguments->loop_work,
                 "Say how much energy a hand could gain round closed loops under each model")
      ->excludes(json);
  command->callback([=, &action] { action = [=] { return prepare(*arguments); }; });
}

}  // namespace touchtrial::app
