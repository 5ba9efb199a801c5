#include "protocols/design/enrolment_plan.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "protocols/design/random_orders.hpp"

#include <algorithm>
#include <functional>
#include <queue>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial::design {
namespace {

constexpr std::size_t kLongestStation = 32;

bool is_name_letter(char letter) {
  return (letter >= '0' && letter <= '9') || (letter >= 'A' && letter <= 'Z') ||
         (letter >= 'a' && letter <= 'z') || letter == '+' || letter == '-' || letter == '_';
}

void require_station_name(const std::string& name) {
  if (!name.empty() && name.size() <= kLongestStation &&
      std::ranges::all_of(name, is_name_letter)) {
    return;
  }
  throw UsageError(in_quotes(name) +
                   " is no name of a station; use 1 to 32 of 0-9, A-Z, a-z, '+', '-', '_'");
}

/// How many more numbers each station gets. Each number goes to the station with the fewest, and
/// among equals to the first.
std::vector<int> numbers_to_hand_out(const EnrolmentPlan& plan, int number) {
  using Standing = std::pair<int, std::size_t>;  // numbers so far, index of the station
  std::priority_queue<Standing, std::vector<Standing>, std::greater<>> smallest;
  for (std::size_t i = 0; i < plan.stations.size(); ++i) {
    smallest.emplace(plan.stations[i].size(), i);
  }
  std::vector<int> more(plan.stations.size(), 0);
  for (int i = 0; i < number; ++i) {
    const auto [size, place] = smallest.top();
    smallest.pop();
    smallest.emplace(size + 1, place);
    ++more[place];
  }
  return more;
}

void add_number(StationShare& share, int number) {
  if (!share.ranges.empty() && share.ranges.back().last == number - 1) {
    share.ranges.back().last = number;
  } else {
    share.ranges.push_back({number, number});
  }
}

/// How many numbers a station still gets, and how often each order of methods has occurred there.
struct Recipient {
  int wanted = 0;
  std::vector<int> orders;

  /// How many more times this order has occurred than the rarest order.
  [[nodiscard]] int excess(std::size_t order) const {
    return orders[order] - *std::ranges::min_element(orders);
  }
};

/// The recipient for a number with this order of methods: the one where the order has the smallest
/// excess, or `current` if no other is better.
std::size_t best_recipient(const std::vector<Recipient>& recipients, std::size_t order,
                           std::size_t current) {
  std::size_t best = recipients.size();
  const auto consider = [&](std::size_t i) {
    if (recipients[i].wanted == 0) return;
    if (best == recipients.size() || recipients[i].excess(order) < recipients[best].excess(order)) {
      best = i;
    }
  };
  consider(current);
  if (best == current && recipients[current].excess(order) == 0) return current;
  for (std::size_t i = 0; i < recipients.size(); ++i) consider(i);
  return best;
}

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

/// Requires that every number up to the last belongs to exactly one station.
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

int StationShare::size() const noexcept {
  int numbers = 0;
  for (const EnrolmentRange& range : ranges) numbers += range.size();
  return numbers;
}

int EnrolmentPlan::participants() const noexcept {
  int numbers = 0;
  for (const StationShare& share : stations) numbers += share.size();
  return numbers;
}

EnrolmentPlan empty_plan(const Study& study, std::span<const std::string> stations) {
  if (stations.empty() || stations.size() > kMostStations) {
    throw UsageError("a plan is for 1 to " + std::to_string(kMostStations) + " stations");
  }
  EnrolmentPlan plan{.study = study.name, .stations = {}};
  std::set<std::string> names;
  for (const std::string& name : stations) {
    require_station_name(name);
    if (!names.insert(name).second) {
      throw UsageError("station " + name + " is named twice; give every station its own name");
    }
    plan.stations.push_back({name, {}});
  }
  return plan;
}

void extend_plan(EnrolmentPlan& plan, const Study& study, int participants) {
  const int had = plan.participants();
  if (plan.stations.empty() || participants < had || participants > kMostPlanned) {
    throw std::invalid_argument("extend_plan: no stations, or an impossible number");
  }
  const std::vector<int> more = numbers_to_hand_out(plan, participants - had);
  std::vector<Recipient> recipients;
  for (std::size_t i = 0; i < more.size(); ++i) {
    recipients.push_back({more[i], orders_of(study, plan.stations[i].ranges)});
  }
  std::size_t current = 0;
  for (int number = had + 1; number <= participants; ++number) {
    const std::size_t order = static_cast<std::size_t>(number) % recipients[current].orders.size();
    current = best_recipient(recipients, order, current);
    add_number(plan.stations[current], number);
    --recipients[current].wanted;
    ++recipients[current].orders[order];
  }
}

std::vector<int> orders_of(const Study& study, std::span<const EnrolmentRange> ranges) {
  const int methods = study.presented_methods();
  const bool has_orders = methods > 1 && study.trials.blocks != Blocks::mixed;
  const int rows = has_orders ? williams_rows(methods) : 1;
  std::vector<int> counts(static_cast<std::size_t>(rows), 0);
  for (const EnrolmentRange& range : ranges) {
    for (int number = range.first; number <= range.last; ++number) {
      ++counts[static_cast<std::size_t>(number % rows)];
    }
  }
  return counts;
}

const std::string* station_of(const EnrolmentPlan& plan, int number) noexcept {
  for (const StationShare& share : plan.stations) {
    for (const EnrolmentRange& range : share.ranges) {
      if (number >= range.first && number <= range.last) return &share.station;
    }
  }
  return nullptr;
}

int next_of_station(const EnrolmentPlan& plan, const std::string& station,
                    const std::set<int>& taken, const std::string& source) {
  const auto share = std::ranges::find(plan.stations, station, &StationShare::station);
  if (share == plan.stations.end()) {
    std::string names;
    for (const StationShare& known : plan.stations) {
      names += (names.empty() ? "" : ", ") + known.station;
    }
    throw StudyError(source + ": has no station " + in_quotes(station) + "; it has " + names);
  }
  for (const EnrolmentRange& range : share->ranges) {
    for (int number = range.first; number <= range.last; ++number) {
      if (!taken.contains(number)) return number;
    }
  }
  throw StudyError(source + ": all numbers of station " + station +
                   " are taken; hand out more with `touchtrial plan --extend`, and give every "
                   "station the new plan");
}

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
