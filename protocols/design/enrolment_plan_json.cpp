#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "protocols/design/enrolment_plan.hpp"

#include <algorithm>
#include <string_view>

#include <nlohmann/json.hpp>

namespace touchtrial::design {
namespace {

constexpr std::size_t kMostRanges = 10'000;
constexpr std::size_t kMostBytes = 16U << 20U;

EnrolmentRange read_range(const JsonValue& value) {
  const std::vector<JsonValue> ends = value.items(2, 2);
  const auto first = static_cast<int>(ends[0].integer(1, kMostPlanned));
  const auto last = static_cast<int>(ends[1].integer(1, kMostPlanned));
  if (last < first) value.refuse("the numbers end before they begin; exchange the two");
  return {first, last};
}

StationShare read_share(const JsonValue& value) {
  const JsonObject object = value.object({"station", "enrolments"});
  StationShare share{.station = object.at("station").text(), .ranges = {}};
  for (const JsonValue& range : object.at("enrolments").items(0, kMostRanges)) {
    share.ranges.push_back(read_range(range));
  }
  return share;
}

/// Every number up to the last belongs to one station.
void require_partition(const JsonValue& stations, const EnrolmentPlan& plan) {
  std::vector<EnrolmentRange> all;
  for (const StationShare& share : plan.stations) {
    all.insert(all.end(), share.ranges.begin(), share.ranges.end());
  }
  std::ranges::sort(all, {}, &EnrolmentRange::first);
  int next = 1;
  for (const EnrolmentRange& range : all) {
    if (range.first != next) {
      stations.refuse("number " + std::to_string(std::min(range.first, next)) +
                      (range.first < next ? " is two stations'" : " is no station's") +
                      "; restore the plan that `touchtrial plan` wrote");
    }
    next = range.last + 1;
  }
}

EnrolmentPlan read_plan(const JsonValue& document, const Study& study) {
  const JsonObject object = document.object({"study", "stations"});
  const std::string& name = object.at("study").text();
  if (name != study.name) {
    object.at("study").refuse("the plan is of study " + in_quotes(name) + ", not of " +
                              in_quotes(study.name) + "; give this study's plan");
  }
  std::vector<StationShare> shares;
  std::vector<std::string> names;
  const JsonValue stations = object.at("stations");
  for (const JsonValue& item : stations.items(1, kMostStations)) {
    shares.push_back(read_share(item));
    names.push_back(shares.back().station);
  }
  EnrolmentPlan plan;
  try {
    plan = empty_plan(study, names);
  } catch (const UsageError& error) {
    stations.refuse(error.what());
  }
  plan.stations = std::move(shares);
  require_partition(stations, plan);
  return plan;
}

}  // namespace

std::filesystem::path plan_path_for(const std::filesystem::path& study_file) {
  return study_file.parent_path() / (study_file.stem().string() + ".plan.json");
}

EnrolmentPlan load_plan(const std::filesystem::path& path, const Study& study) {
  const Bytes bytes = read_file(path, kMostBytes);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return read_plan(parse_strict_json(text, path.string()), study);
}

void save_plan(const std::filesystem::path& path, const EnrolmentPlan& plan) {
  nlohmann::ordered_json stations = nlohmann::ordered_json::array();
  for (const StationShare& share : plan.stations) {
    nlohmann::ordered_json ranges = nlohmann::ordered_json::array();
    for (const EnrolmentRange& range : share.ranges) ranges.push_back({range.first, range.last});
    stations.push_back({{"station", share.station}, {"enrolments", std::move(ranges)}});
  }
  const nlohmann::ordered_json document = {{"study", plan.study}, {"stations", stations}};
  replace_file(path, document.dump(2) + "\n");
}

}  // namespace touchtrial::design
