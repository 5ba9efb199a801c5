#include "analysis/planning/power_progress.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/hash.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace touchtrial::planning {
namespace {

using nlohmann::ordered_json;

constexpr const char* kFormat = "touchtrial power progress";
constexpr int kVersion = 4;
constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 29U;

ordered_json setting_object(const PowerSetting& setting) {
  return {{"study", setting.study},     {"protocol", setting.protocol},
          {"test", setting.test},       {"estimate", setting.estimate},
          {"seal", setting.seal},       {"fields", setting.fields},
          {"subject", setting.subject}, {"program", setting.program},
          {"draws", setting.draws},     {"has_fixed_counts", setting.has_fixed_counts},
          {"device", setting.device}};
}

ordered_json stored_plan(const PowerPlan& plan) {
  return {{"participants", plan.participants},
          {"runs", plan.runs},
          {"seed", plan.seed},
          {"stop_early", plan.stop_early},
          {"servo", plan.servo},
          {"explorations", plan.explorations},
          {"trainings", plan.trainings},
          {"level", plan.level},
          {"margin", plan.margin},
          {"first_half_loss", plan.first_half_loss},
          {"effect", plan.effect}};
}

ordered_json cell_object(const PowerCell& cell) {
  ordered_json runs = ordered_json::array();
  for (const PowerRun& run : cell.runs) {
    runs.push_back(ordered_json::array({run.p, run.attainable, run.estimate, run.low, run.high}));
  }
  return {{"participants", cell.participants},
          {"hypothesis", name_of(cell.hypothesis)},
          {"runs", std::move(runs)}};
}

ordered_json progress_object(const PowerProgress& progress) {
  ordered_json cells = ordered_json::array();
  for (const PowerCell& cell : progress.cells) cells.push_back(cell_object(cell));
  return {{"format", kFormat},
          {"version", kVersion},
          {"simulated", true},
          {"setting", setting_object(progress.setting)},
          {"plan", stored_plan(progress.plan)},
          {"shard", {progress.shard.number, progress.shard.count}},
          {"cells", std::move(cells)}};
}

std::string digest_of(const ordered_json& object) {
  return to_hex(sha256(bytes_of(object.dump())));
}

/// Thrown for content that no version of the program writes.
struct Malformed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void require(bool holds, const char* what) {
  if (!holds) throw Malformed(what);
}

PowerSetting setting_of(const ordered_json& object) {
  return {object.at("study"),   object.at("protocol"),
          object.at("test"),    object.at("estimate"),
          object.at("seal"),    object.at("fields"),
          object.at("subject"), object.at("program"),
          object.at("draws"),   object.at("has_fixed_counts"),
          object.at("device")};
}

PowerPlan plan_of(const ordered_json& object) {
  PowerPlan plan;
  plan.participants = object.at("participants").get<std::vector<int>>();
  plan.runs = object.at("runs");
  plan.seed = object.at("seed");
  plan.stop_early = object.at("stop_early");
  plan.servo = object.at("servo");
  plan.explorations = object.at("explorations");
  plan.trainings = object.at("trainings");
  plan.level = object.at("level");
  plan.margin = object.at("margin");
  plan.first_half_loss = object.at("first_half_loss");
  plan.effect = object.at("effect");
  require(plan.margin >= 0.0 && plan.margin <= 1.0, "its margin is out of range");
  require(plan.level > 0.0 && plan.level < 1.0, "its level is out of range");
  const PowerPlan as_written = plan;
  settle(plan);
  require(plan == as_written, "its sizes are not in order");
  return plan;
}

PowerRun run_of(const ordered_json& row) {
  require(row.is_array() && row.size() == 5, "a run does not have five numbers");
  const PowerRun run{row[0], row[1], row[2], row[3], row[4]};
  const bool finite = std::isfinite(run.p) && std::isfinite(run.attainable) &&
                      std::isfinite(run.estimate) && std::isfinite(run.low) &&
                      std::isfinite(run.high);
  require(finite && run.p >= 0.0 && run.p <= 1.0, "a run's numbers are impossible");
  return run;
}

void read_cell(const ordered_json& object, int most_runs, PowerCell& cell) {
  require(object.at("participants") == cell.participants &&
              object.at("hypothesis") == name_of(cell.hypothesis),
          "its sizes are not those of its plan");
  const ordered_json& runs = object.at("runs");
  require(runs.is_array() && runs.size() <= static_cast<std::size_t>(most_runs),
          "it has more runs than its plan");
  for (const ordered_json& row : runs) cell.runs.push_back(run_of(row));
}

PowerProgress progress_of(const ordered_json& object) {
  require(object.at("format") == kFormat && object.at("version") == kVersion,
          "it has another format or version");
  const ordered_json& shard = object.at("shard");
  require(shard.is_array() && shard.size() == 2, "it names no shard");
  const Shard place{shard[0], shard[1]};
  require(place.count >= 1 && place.count <= kMostShards && place.number >= 1 &&
              place.number <= place.count,
          "it names no shard");
  PowerProgress progress =
      new_progress(setting_of(object.at("setting")), plan_of(object.at("plan")), place);
  const ordered_json& cells = object.at("cells");
  require(cells.is_array() && cells.size() == progress.cells.size(),
          "its sizes are not those of its plan");
  for (std::size_t i = 0; i < progress.cells.size(); ++i) {
    read_cell(cells[i], place.own_runs(progress.plan.runs), progress.cells[i]);
  }
  return progress;
}

[[noreturn]] void refuse_progress(const std::filesystem::path& path, const std::string& what) {
  throw FileError(one_line(path.string() + ": is not the progress of a power run (" + what +
                           "); give a folder or file that power wrote"));
}

}  // namespace

std::string progress_json(const PowerProgress& progress) {
  const ordered_json object = progress_object(progress);
  return ordered_json{{"power", object}, {"sha256", digest_of(object)}}.dump() + "\n";
}

PowerProgress load_progress(const std::filesystem::path& path) {
  const Bytes content = read_file(path, kLargestFile);
  try {
    const ordered_json document = ordered_json::parse(text_of(content));
    const ordered_json& object = document.at("power");
    require(document.at("sha256") == digest_of(object), "it is truncated or was altered");
    return progress_of(object);
  } catch (const ordered_json::exception&) {
    refuse_progress(path, "it is truncated, or not JSON of this form");
  } catch (const Malformed& error) {
    refuse_progress(path, error.what());
  } catch (const UsageError& error) {
    refuse_progress(path, error.what());
  }
}

}  // namespace touchtrial::planning
