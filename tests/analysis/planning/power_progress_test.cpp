#include "analysis/planning/power_progress.hpp"

#include "analysis/planning/power_report.hpp"
#include "analysis/planning/rehearsed_tiny_study.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

planning::PowerPlan small_plan(int runs = 130) {
  planning::PowerPlan plan;
  plan.participants = {3, 5};
  plan.runs = runs;
  return plan;
}

/// Eleven people name the textures of the tiny study so well that its power is certain at the
/// first look.
planning::PowerPlan easy_plan() {
  planning::PowerPlan plan = small_plan(150);
  plan.participants = {11, 12};
  return plan;
}

planning::PowerSetting setting(const std::string& subject = "somebody") {
  return {"tiny", "classification", "a test", "accuracy", "5ea1", "f1e1d5", subject, "0"};
}

/// A text without its line ends and indents.
std::string unwrapped(const std::string& text) {
  std::istringstream words(text);
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

/// Made once for all cases of this file.
const RehearsedTinyStudy& tiny() {
  static const RehearsedTinyStudy study([] {
    TinyStudyOptions options;
    options.side_px = 60;
    options.trials = R"({"repeats":2})";
    return options;
  }());
  return study;
}

const planning::BankedFeelings& bank() {
  static const planning::BankedFeelings feelings = tiny().bank();
  return feelings;
}

planning::PowerProgress made(const planning::PowerPlan& plan, const planning::Shard& shard = {},
                             int jobs = 2) {
  planning::PowerProgress progress = planning::new_progress(setting(), plan, shard);
  planning::make_runs(tiny().planned(bank()), tiny().test, {.jobs = jobs}, progress);
  return progress;
}

using Files = std::vector<std::pair<std::filesystem::path, planning::PowerProgress>>;

Files shards(const planning::PowerPlan& plan, int count) {
  Files files;
  for (int number = 1; number <= count; ++number) {
    files.emplace_back("shard-" + std::to_string(number), made(plan, {number, count}));
  }
  return files;
}

TEST_CASE("a power run is the same with any number of threads") {
  const planning::PowerProgress one = made(small_plan(), {}, 1);
  CHECK(planning::is_complete(one));
  CHECK(one == made(small_plan(), {}, 3));
  CHECK(planning::power_json(planning::make_power_report(one)) ==
        planning::power_json(planning::make_power_report(made(small_plan()))));
}

TEST_CASE("a bank of feelings is the same with any number of threads") {
  const planning::BankedFeelings one = tiny().bank(3, 2, 1, 1);
  const planning::BankedFeelings other = tiny().bank(3, 2, 1, 3);
  for (std::uint64_t draw = 0; draw < 3; ++draw) {
    CHECK(one.felt({1, 0, 0}, {5, 1, 1, draw}) == other.felt({1, 0, 0}, {5, 1, 1, draw}));
  }
  CHECK(one.felt({1, 0, 0}, {5, 1, 1, 0}) != one.felt({1, 0, 0}, {5, 1, 1, 1}));
  CHECK(one.knowledge(7)->examples.front().features ==
        other.knowledge(7)->examples.front().features);
}

TEST_CASE("shards in any number and order make the whole run, to the last digit") {
  const planning::PowerProgress whole = made(small_plan());
  for (const int count : {2, 5}) {
    Files files = shards(small_plan(), count);
    std::reverse(files.begin(), files.end());
    const planning::CombinedPower all = planning::combined(files);
    CHECK(all.remarks.empty());
    CHECK(all.progress == whole);
    CHECK(planning::power_json(planning::make_power_report(all.progress)) ==
          planning::power_json(planning::make_power_report(whole)));
  }
}

TEST_CASE("shards make all their runs, and the combined run stops where one machine would have") {
  planning::PowerPlan plan = easy_plan();
  const planning::PowerProgress whole = made(plan);
  REQUIRE(whole.cells.front().runs.size() == 100);
  const Files files = shards(plan, 3);
  for (const auto& [path, shard] : files) CHECK(shard.cells.front().runs.size() == 50);
  CHECK(planning::combined(files).progress == whole);
  plan.stop_early = false;
  CHECK(made(plan).cells.front().runs.size() == 150);
}

TEST_CASE("a single shard is the whole run, even if it stopped early") {
  const planning::PowerPlan plan = easy_plan();
  const planning::PowerProgress whole = made(plan);
  REQUIRE(whole.cells.front().runs.size() == 100);
  CHECK(planning::combined({{"shard", whole}}).progress == whole);
}

TEST_CASE("shards without runs are required too") {
  const planning::PowerPlan plan = small_plan(3);
  Files files = shards(plan, 5);
  CHECK(files.back().second.cells.front().runs.empty());
  CHECK(planning::combined(files).progress == made(plan));
  files.pop_back();
  CHECK_THROWS_WITH(planning::combined(files), holds_text("missing: 5"));
}

TEST_CASE("missing shards are named") {
  Files files = shards(small_plan(10), 5);
  files.erase(files.begin() + 3);
  files.erase(files.begin() + 1);
  CHECK_THROWS_WITH(planning::combined(files), holds_text("missing: 2, 4"));
  CHECK_THROWS_AS(planning::combined({}), FileError);
}

TEST_CASE("a repeated shard is taken once with a remark, and a differing one is refused") {
  Files files = shards(small_plan(10), 3);
  files.emplace_back("again", files[1].second);
  const planning::CombinedPower all = planning::combined(files);
  REQUIRE(all.remarks.size() == 1);
  CHECK_THAT(all.remarks.front(), holds_text("2/3") && holds_text("again"));
  CHECK(all.progress == made(small_plan(10)));
  files.back().second.cells[0].runs[0].p *= 0.5;
  CHECK_THROWS_AS(planning::combined(files), VerificationError);
  CHECK_THROWS_WITH(planning::combined(files), holds_text("again"));
}

TEST_CASE("a shard of another study, plan or number of shards is refused by name") {
  Files files = shards(small_plan(10), 3);
  const auto with = [&](const auto& change) {
    Files changed = files;
    change(changed[2].second);
    return changed;
  };
  CHECK_THROWS_WITH(
      planning::combined(with([](planning::PowerProgress& p) { p.setting.seal = "other"; })),
      holds_text("shard-3") && holds_text("the study file"));
  CHECK_THROWS_WITH(
      planning::combined(with([](planning::PowerProgress& p) { p.setting.subject = "other"; })),
      holds_text("the subject model"));
  CHECK_THROWS_WITH(planning::combined(with([](planning::PowerProgress& p) { p.plan.seed = 9; })),
                    holds_text("--seed"));
  CHECK_THROWS_WITH(planning::combined(with([](planning::PowerProgress& p) { p.plan.runs = 9; })),
                    holds_text("--runs"));
  CHECK_THROWS_WITH(planning::combined(with([](planning::PowerProgress& p) { p.shard.count = 4; })),
                    holds_text("shard 3/4"));
  CHECK_THROWS_WITH(
      planning::combined(with([](planning::PowerProgress& p) { p.cells[1].runs.pop_back(); })),
      holds_text("not complete"));
}

TEST_CASE("to a power run another hand is another subject model") {
  const simulation::SubjectModel usual;
  simulation::SubjectModel grip;
  grip.hand = device::HandKind::stylus_grip;
  simulation::SubjectModel spread;
  spread.hand_spread = 0.2;
  CHECK(planning::words_of(grip) != planning::words_of(usual));
  CHECK(planning::words_of(spread) != planning::words_of(usual));
  CHECK(planning::words_of(spread).find("hand point_mass (spread 0.2)") != std::string::npos);
}

TEST_CASE("progress is unchanged after writing and reading") {
  const TempFolder folder;
  const auto file = folder.path() / "progress.json";
  planning::PowerProgress progress = made(small_plan(20), {2, 3});
  progress.cells[0].runs[0] = {1e-280, 0.05, 0.1 + 0.2, -1.0 / 3.0, 5e-324};
  progress.plan.seed = ~std::uint64_t{0};
  replace_file(file, planning::progress_json(progress));
  CHECK(planning::load_progress(file) == progress);
}

/// Thrown in place of killing the program: only what was kept last remains.
struct Killed {};

TEST_CASE("a power run that was killed at any time resumes to the same result") {
  const planning::PowerProgress whole = made(small_plan());
  const TempFolder folder;
  const auto file = folder.path() / "progress.json";
  for (int blocks = 0; blocks < 7; ++blocks) {
    planning::PowerProgress progress = planning::new_progress(setting(), small_plan(), {});
    int kept = 0;
    planning::PowerWork work{.jobs = 2};
    work.keep = [&](const planning::PowerProgress& so_far) {
      replace_file(file, planning::progress_json(so_far));
      if (++kept > blocks) throw Killed();
    };
    CHECK_THROWS_AS(planning::make_runs(tiny().planned(bank()), tiny().test, work, progress),
                    Killed);
    planning::PowerProgress taken_up = planning::load_progress(file);
    REQUIRE_FALSE(taken_up.cells == whole.cells);
    planning::make_runs(tiny().planned(bank()), tiny().test, {.jobs = 1}, taken_up);
    CHECK(taken_up == whole);
  }
}

TEST_CASE("a file of progress that is truncated, altered or hostile is refused in one line") {
  const TempFolder folder;
  const auto file = folder.path() / "progress.json";
  const std::string text = planning::progress_json(made(small_plan(10)));
  const auto refused = [&](const std::string& content) {
    replace_file(file, content);
    try {
      static_cast<void>(planning::load_progress(file));
    } catch (const FileError& error) {
      const std::string what = error.what();
      return what.find('\n') == std::string::npos &&
             what.find("progress.json") != std::string::npos;
    }
    return false;
  };
  REQUIRE_FALSE(refused(text));
  for (std::size_t length = 0; length + 2 < text.size(); length += 37) {
    CHECK(refused(text.substr(0, length)));
  }
  std::string altered = text;
  altered[altered.find("\"runs\":10") + 8] = '2';
  CHECK(refused(altered));
  CHECK(refused(""));
  CHECK(refused("[]"));
  CHECK(refused("null"));
  CHECK(refused(std::string(100'000, '[')));
  CHECK(refused("{\"power\":1,\"sha256\":\"\"}"));
  CHECK(refused("{\"power\":{},\"sha256\":5}"));
  CHECK(refused("\xff\xfe{}"));
}

TEST_CASE("the report of a power run agrees with its runs") {
  planning::PowerProgress progress = planning::new_progress(setting(), small_plan(4), {});
  for (planning::PowerCell& cell : progress.cells) {
    const double width = cell.participants == 3 ? 0.4 : 0.2;
    const bool null = cell.hypothesis == planning::Hypothesis::null;
    for (int run = 0; run < 4; ++run) {
      const double p = null ? 0.5 : run == 0 && cell.participants == 3 ? 0.06 : 0.01;
      cell.runs.push_back({p, null ? 0.04 : 0.0, 0.5, 0.5 - width / 2, 0.5 + width / 2});
    }
  }
  const planning::PowerReport report = planning::make_power_report(progress);
  REQUIRE(report.rows.size() == 2);
  CHECK(report.rows[0].significant == (analysis::Proportion{4, 3}));
  CHECK(report.rows[1].significant == (analysis::Proportion{4, 4}));
  CHECK(report.rows[0].width.mean == Approx(0.4));
  CHECK(report.rows[1].width.median == Approx(0.2));
  CHECK(report.rows[0].false_alarms == (analysis::Proportion{4, 0}));
  CHECK(report.rows[0].attainable == Approx(0.04));
  CHECK(report.targets[0].smallest == 5);
  CHECK_FALSE(report.targets[0].surely.has_value());
  const auto json = nlohmann::json::parse(planning::power_json(report));
  CHECK(json.at("simulated") == true);
  CHECK(json.at("sizes").at(1).at("power").at("p") == 1.0);
  CHECK(json.at("targets").at(1).at("smallest") == 5);
  for (const std::string& text : {planning::power_text(report), planning::power_markdown(report),
                                  planning::power_csv(report), planning::power_json(report)}) {
    CHECK_THAT(text, holds_text("SIMULATED"));
  }
  CHECK_THAT(planning::power_text(report), holds_text("power given the assumed sensitivity"));
}

TEST_CASE(
    "there is no verdict on the test's error for orders with unequal numbers of presentations") {
  planning::PowerProgress progress = planning::new_progress(setting(), small_plan(100), {});
  for (planning::PowerCell& cell : progress.cells)
    cell.runs.assign(100, {0.01, 0.04, 0.5, 0.4, 0.6});
  CHECK(planning::verdict_of(planning::make_power_report(progress).rows[0]) ==
        planning::ErrorVerdict::excessive);
  CHECK_THAT(unwrapped(planning::power_text(planning::make_power_report(progress))),
             holds_text("does not keep its level"));
  progress.setting.has_fixed_counts = false;
  const planning::PowerReport report = planning::make_power_report(progress);
  CHECK(planning::verdict_of(report.rows[0]) == planning::ErrorVerdict::conditional);
  CHECK_THAT(planning::power_json(report), !holds_text("not keep its level") &&
                                               !holds_text("excessive") &&
                                               holds_text("orders that this study's seed draws"));
}

TEST_CASE("a run that is not complete has no report") {
  CHECK_THROWS_AS(planning::make_power_report(planning::new_progress(setting(), small_plan(), {})),
                  std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
