#include "bench/results_json.hpp"

#include <cmath>
#include <cstddef>

#include <nlohmann/json.hpp>

namespace touchtrial::bench {
namespace {

using Json = nlohmann::ordered_json;

Json figure(double value) {
  return std::isnan(value) ? Json(nullptr) : Json(value);
}

Json word(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json limit_of(const GoalResult& result) {
  constexpr const char* kNames[] = {"ratio", "ours_us", "error", "count"};
  return kNames[static_cast<std::size_t>(result.limit)];
}

Json json_of(const GoalResult& result) {
  return {{"goal", result.goal},
          {"ours_us", figure(result.ours_us)},
          {"peer_us", figure(result.peer_us)},
          {"ratio", figure(result.ratio)},
          {"target", figure(result.target)},
          {"error", figure(result.error)},
          {"met", has_target(result) ? Json(is_met(result)) : Json(nullptr)},
          {"limits", limit_of(result)},
          {"peer", word(result.peer)},
          {"error_unit", word(result.error_unit)},
          {"count", figure(result.count)},
          {"count_unit", word(result.count_unit)}};
}

Json json_of(const Row& row) {
  const Case& what = row.what;
  return {{"work", what.work},
          {"who", what.who},
          {"input", word(what.input)},
          {"size_px", what.size_px > 0 ? Json(what.size_px) : Json(nullptr)},
          {"radius", what.radius > 0 ? Json(what.radius) : Json(nullptr)},
          {"us", figure(row.us)},
          {"error", figure(row.error)},
          {"error_unit", word(what.accuracy.unit)}};
}

template <class Entries>
Json list_of(const Entries& entries) {
  Json list = Json::array();
  for (const auto& entry : entries) list.push_back(json_of(entry));
  return list;
}

}  // namespace

std::string results_json(const Machine& machine, const std::vector<GoalResult>& goals,
                         const std::vector<Row>& rows) {
  const Json results = {{"processor", machine.processor}, {"compiler", machine.compiler},
                        {"opencv", machine.opencv},       {"date", machine.date},
                        {"goals", list_of(goals)},        {"rows", list_of(rows)}};
  return results.dump(1) + "\n";
}

}  // namespace touchtrial::bench
