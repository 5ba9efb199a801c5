#include "record/merging/enrolment_balance.hpp"

#include "core/text.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>

namespace touchtrial::merging {
namespace {

bool is_uneven(const std::map<int, int>& counts) {
  const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto [min, max] = std::minmax_element(counts.begin(), counts.end(), less);
  return min != counts.end() && max->second - min->second > 1;
}

void add_gaps(EnrolmentBalance& balance, const std::set<int>& taken) {
  // The highest number may be very large, so the loop stops when the list is full.
  const auto below = std::distance(taken.begin(), taken.lower_bound(balance.highest));
  balance.gap_count = std::max(balance.highest - 1, 0) - static_cast<int>(below);
  for (int number = 1; number < balance.highest && balance.gaps.size() < kMaxGaps; ++number) {
    if (!taken.contains(number)) balance.gaps.push_back(number);
  }
}

std::string listed_stations(const EnrolmentBalance& balance) {
  std::string text;
  for (const auto& [station, count] : balance.stations) {
    text += (text.empty() ? "station " : ", station ") + std::to_string(station) + " has " +
            std::to_string(count);
  }
  return text;
}

std::string numbers_text(const std::vector<int>& numbers) {
  return listed(numbers, ", ", [](int number) { return std::to_string(number); });
}

std::string gaps_line(const EnrolmentBalance& balance) {
  std::string line =
      "enrolment numbers without a complete session that counts: " + numbers_text(balance.gaps);
  const std::size_t more = static_cast<std::size_t>(balance.gap_count) - balance.gaps.size();
  return more == 0 ? line : line + " and " + std::to_string(more) + " more";
}

}  // namespace

EnrolmentBalance enrolment_balance(std::span<const EnrolledSession> sessions) {
  EnrolmentBalance balance;
  std::set<int> taken;
  for (const EnrolledSession& session : sessions) {
    if (session.enrolment < 1) throw std::invalid_argument("enrolment_balance: numbers start at 1");
    balance.highest = std::max(balance.highest, session.enrolment);
    int& at_station = balance.stations[session.station];
    if (!session.counts || session.state != record::SessionState::completed) continue;
    ++at_station;
    taken.insert(session.enrolment);
  }
  add_gaps(balance, taken);
  return balance;
}

std::vector<std::string> imbalances(const EnrolmentBalance& balance) {
  std::vector<std::string> lines;
  if (is_uneven(balance.stations)) {
    lines.push_back("numbers of complete sessions differ between stations: " +
                    listed_stations(balance));
  }
  if (balance.gap_count > 0) lines.push_back(gaps_line(balance));
  return lines;
}

}  // namespace touchtrial::merging
