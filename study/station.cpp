#include "study/station.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "core/strict_json.hpp"
#include "study/random_orders.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <stdexcept>
#include <utility>

namespace touchtrial::study {
namespace {

constexpr std::size_t kMaxStationName = 32;

bool is_name_letter(char letter) {
  return (letter >= '0' && letter <= '9') || (letter >= 'A' && letter <= 'Z') ||
         (letter >= 'a' && letter <= 'z') || letter == '+' || letter == '-' || letter == '_';
}

void require_station_name(const std::string& name) {
  if (!name.empty() && name.size() <= kMaxStationName &&
      std::ranges::all_of(name, is_name_letter)) {
    return;
  }
  throw UsageError(in_quotes(name) +
                   " is not a valid station name; use 1 to 32 of 0-9, A-Z, a-z, '+', '-', '_'");
}

/// The number of enrolment numbers that each station gets. Each goes to the station with the fewest
/// numbers, or to the first of several.
std::vector<int> counts_per_station(std::span<const Station> stations, int numbers) {
  using SizeAndIndex = std::pair<int, std::size_t>;  // of a station
  std::priority_queue<SizeAndIndex, std::vector<SizeAndIndex>, std::greater<>> smallest;
  for (std::size_t i = 0; i < stations.size(); ++i) smallest.emplace(stations[i].size(), i);
  std::vector<int> added(stations.size(), 0);
  for (int i = 0; i < numbers; ++i) {
    const auto [size, index] = smallest.top();
    smallest.pop();
    smallest.emplace(size + 1, index);
    ++added[index];
  }
  return added;
}

SecretKey secret_for(const Station& station, Draws draws) {
  return derive_key(station.secret, draws == Draws::people ? "schedules" : "rehearsed schedules");
}

/// The group of an enrolment number, and its place among the group's numbers at its station.
struct GroupAssignment {
  int group = 0;
  int place = 0;
};

GroupAssignment assign_group(const GroupPlan& plan, const SecretKey& secret, int place) {
  if (plan.labels.empty()) return {0, place};
  const std::size_t groups = plan.labels.size();
  std::vector<int> members(groups, 0);
  RandomStream random(secret, "groups");
  for (int numbers_left = place;;) {
    std::vector<std::size_t> block(groups * (plan.open ? 1 + random.below(2) : 1));
    for (std::size_t i = 0; i < block.size(); ++i) block[i] = i % groups;
    shuffle(std::span<std::size_t>(block), random);
    for (const std::size_t group : block) {
      if (numbers_left-- == 0) return {static_cast<int>(group), members[group]};
      ++members[group];
    }
  }
}

/// The row of the Williams design at a place. Each block of `rows` places has all rows, in random
/// order.
int row_of(const SecretKey& secret, int rows, int place) {
  std::vector<int> order(static_cast<std::size_t>(rows));
  std::iota(order.begin(), order.end(), 0);
  RandomStream random(secret, "orders of methods", static_cast<std::uint64_t>(place / rows));
  shuffle(std::span<int>(order), random);
  return order[static_cast<std::size_t>(place % rows)];
}

}  // namespace

int Station::size() const noexcept {
  int numbers = 0;
  for (const EnrolmentRange& range : ranges) numbers += range.size();
  return numbers;
}

std::optional<int> Station::place_of(int enrolment) const noexcept {
  int preceding = 0;
  for (const EnrolmentRange& range : ranges) {
    if (enrolment >= range.first && enrolment <= range.last) {
      return preceding + enrolment - range.first;
    }
    preceding += range.size();
  }
  return std::nullopt;
}

int method_orders(const Study& study) {
  const int methods = study.presented_methods();
  return methods > 1 && study.trials.blocks != Blocks::mixed ? williams_rows(methods) : 1;
}

ScheduleDraw draw_for(const Study& study, const Station& station, int enrolment, Draws draws,
                      int visit) {
  const std::optional<int> place = station.place_of(enrolment);
  if (!place) {
    throw UsageError("enrolment number " + std::to_string(enrolment) + " is not one of station " +
                     station.name +
                     "'s; use one of its numbers, or assign more with `touchtrial plan --extend`");
  }
  if (visit < 1 || visit > study.visits.count) {
    throw UsageError("visit " + std::to_string(visit) +
                     " does not exist; the study has visits 1 to " +
                     std::to_string(study.visits.count));
  }
  const SecretKey secret = secret_for(station, draws);
  const GroupAssignment assignment = assign_group(study.groups, secret, *place);
  // If every visit presents all methods, each visit has its own trial order.
  const bool is_repeat = visit > 1 && study.visits.methods == VisitMethods::all;
  return {
      .secret = derive_key(secret, "participant " + std::to_string(enrolment) +
                                       (is_repeat ? ", visit " + std::to_string(visit) : "")),
      .method_order = row_of(study.groups.labels.empty()
                                 ? secret
                                 : derive_key(secret, "group " + std::to_string(assignment.group)),
                             method_orders(study), assignment.place),
      .visit = visit};
}

std::optional<int> group_for(const Study& study, const Station& station, int enrolment,
                             Draws draws) {
  const std::optional<int> place = station.place_of(enrolment);
  if (!place || study.groups.labels.empty()) return std::nullopt;
  return assign_group(study.groups, secret_for(station, draws), *place).group;
}

int order_block_of(const Study& study, std::span<const Station> stations, int enrolment,
                   Draws draws) {
  const int rows = method_orders(study);
  const int groups = std::max(1, static_cast<int>(study.groups.labels.size()));
  int preceding = 0;  // blocks of earlier stations
  for (const Station& station : stations) {
    if (const auto place = station.place_of(enrolment)) {
      const GroupAssignment assignment =
          assign_group(study.groups, secret_for(station, draws), *place);
      return preceding + assignment.place / rows * groups + assignment.group;
    }
    preceding += (station.size() / rows + 1) * groups;
  }
  return -1;
}

std::vector<Station> stations_named(std::span<const std::string> names) {
  if (names.empty() || names.size() > kMaxStations) {
    throw UsageError("a plan must have 1 to " + std::to_string(kMaxStations) + " stations, not " +
                     std::to_string(names.size()));
  }
  std::vector<Station> stations;
  std::set<std::string> seen;
  for (const std::string& name : names) {
    require_station_name(name);
    if (!seen.insert(name).second) {
      throw UsageError("station " + name + " occurs twice; give every station its own name");
    }
    stations.push_back({.name = name, .ranges = {}});
  }
  return stations;
}

int enrolment_count(std::span<const Station> stations) noexcept {
  int numbers = 0;
  for (const Station& station : stations) numbers += station.size();
  return numbers;
}

void assign_enrolments(std::span<Station> stations, int participants) {
  const int assigned = enrolment_count(stations);
  if (stations.empty() || participants < assigned || participants > kMaxEnrolments) {
    throw std::invalid_argument("assign_enrolments: no stations, or an impossible number");
  }
  const std::vector<int> added = counts_per_station(stations, participants - assigned);
  int next_number = assigned + 1;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (added[i] == 0) continue;
    std::vector<EnrolmentRange>& ranges = stations[i].ranges;
    if (!ranges.empty() && ranges.back().last == next_number - 1) {
      ranges.back().last += added[i];
    } else {
      ranges.push_back({next_number, next_number + added[i] - 1});
    }
    next_number += added[i];
  }
}

int next_enrolment_of(const Station& station, const std::set<int>& taken) {
  for (const EnrolmentRange& range : station.ranges) {
    for (int number = range.first; number <= range.last; ++number) {
      if (!taken.contains(number)) return number;
    }
  }
  throw StudyError("all enrolment numbers of station " + station.name +
                   " are in use; assign more with `touchtrial plan --extend`, and copy the new "
                   "station file to the station");
}

const Station* station_of(std::span<const Station> stations, int enrolment) noexcept {
  const auto found = std::ranges::find_if(stations, [enrolment](const Station& station) {
    return station.place_of(enrolment).has_value();
  });
  return found == stations.end() ? nullptr : &*found;
}

}  // namespace touchtrial::study
