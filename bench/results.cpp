#include "bench/results.hpp"

#include "bench/figures.hpp"
#include "bench/jitter/results.hpp"
#include "bench/measure/simd_target.hpp"
#include "core/bytes.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "tests/engine/simd/targets.hpp"

#include <cmath>
#include <cstddef>
#include <ctime>
#include <string>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/core/version.hpp>

namespace touchtrial::bench {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isnan(value) ? Json(nullptr) : Json(value);
}

Json word(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json limit_of(const GoalResult& result) {
  constexpr const char* kNames[] = {"ratio", "of_bound", "ours_us", "error", "count"};
  return kNames[static_cast<std::size_t>(result.limit)];
}

Json json_of(const GoalResult& result) {
  return {{"goal", result.goal},
          {"ours_us", number(result.ours_us)},
          {"peer_us", number(result.peer_us)},
          {"ratio", number(result.ratio)},
          {"bound", word(result.bound)},
          {"bound_us", number(result.bound_us)},
          {"of_bound", number(result.of_bound)},
          {"target", number(result.target)},
          {"error", number(result.error)},
          {"met", has_target(result) ? Json(is_met(result)) : Json(nullptr)},
          {"limits", limit_of(result)},
          {"peer", word(result.peer)},
          {"error_unit", word(result.error_unit)},
          {"count", number(result.count)},
          {"count_unit", word(result.count_unit)}};
}

Json json_of(const Row& row) {
  const Case& what = row.what;
  return {{"work", what.work},
          {"who", what.who},
          {"input", word(what.input)},
          {"size_px", what.size_px > 0 ? Json(what.size_px) : Json(nullptr)},
          {"radius", what.radius > 0 ? Json(what.radius) : Json(nullptr)},
          {"us", number(row.us)},
          {"error", number(row.error)},
          {"error_unit", word(what.accuracy.unit)}};
}

template <class Entries>
Json list_of(const Entries& entries) {
  Json list = Json::array();
  for (const auto& entry : entries) list.push_back(json_of(entry));
  return list;
}

}  // namespace

std::string results_json(const Machine& machine, const Results& measured) {
  const Json results = {{"processor", machine.processor},   {"compiler", machine.compiler},
                        {"opencv", machine.opencv},         {"date", machine.date},
                        {"goals", list_of(measured.goals)}, {"rows", list_of(measured.rows)}};
  return results.dump(1) + "\n";
}

std::string processor_of(std::string_view json) {
  try {
    return Json::parse(json).at("processor").get<std::string>();
  } catch (const Json::exception& error) {
    throw Error(std::string("the committed results are not the benchmark's JSON: ") + error.what());
  }
}

Machine this_machine() {
  return {
      fmt::format("{}, {}", jitter::this_processor(), instruction_set_of(simd_targets().front())),
      TOUCHTRIAL_COMPILER, CV_VERSION, fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))};
}

std::string with_section(const std::string& page, const std::string& name,
                         const std::string& content) {
  const std::string first = "<!-- " + name + " -->\n";
  const std::string last = "<!-- end of " + name + " -->\n";
  const std::size_t begin = page.find(first);
  const std::size_t end = begin == std::string::npos ? begin : page.find(last, begin);
  if (end == std::string::npos) {
    throw Error("the page has no section '" + name + "'; put the lines <!-- " + name +
                " --> and <!-- end of " + name + " --> where the section belongs");
  }
  return page.substr(0, begin + first.size()) + "\n" + content + "\n" + page.substr(end);
}

void publish(const Machine& machine, const Results& results, const std::filesystem::path& folder) {
  const std::filesystem::path page = folder / "README.md";
  const Bytes bytes = read_file(page);
  const std::string text(bytes.begin(), bytes.end());
  const std::string section =
      fmt::format("{}; {}, OpenCV {}; {}.\n\n{}", machine.processor, machine.compiler,
                  machine.opencv, machine.date, goals_table(results.goals));
  const std::string updated = with_section(text, "goals", section);
  draw_figures(results.rows, results.courses, folder);
  replace_file(folder / "results.json", results_json(machine, results));
  replace_file(page, updated);
}

}  // namespace touchtrial::bench
