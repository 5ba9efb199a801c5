/// \file The stations of a study: the enrolment numbers of each, and the secret that determines the
/// schedules of its participants. Rules: docs/several-stations.md.
#pragma once

#include "core/cipher.hpp"
#include "study/schedule.hpp"
#include "study/study.hpp"

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::study {

/// Consecutive numbers, both ends included.
struct EnrolmentRange {
  int first = 1;
  int last = 1;  ///< >= first

  [[nodiscard]] int size() const noexcept { return last - first + 1; }
  friend bool operator==(const EnrolmentRange&, const EnrolmentRange&) = default;
};

inline constexpr int kMaxEnrolments = 1'000'000;
inline constexpr std::size_t kMaxStations = 1000;
/// The name of the only station of an undivided study, which owns all enrolment numbers.
inline constexpr const char* kOnlyStation = "main";

/// One station.
struct Station {
  std::string name;  ///< unique in its study; has the characters of participant ids
  std::vector<EnrolmentRange> ranges;  ///< its numbers, in the order of assignment
  SecretKey secret{};                  ///< determines its schedules; derived from the study's key

  [[nodiscard]] int size() const noexcept;
  /// The place of a number among the station's numbers, from 0; empty if it is another station's.
  [[nodiscard]] std::optional<int> place_of(int enrolment) const noexcept;
  friend bool operator==(const Station&, const Station&) = default;
};

/// The stream from which schedules are drawn. Pilots and simulated participants have their own, so
/// that no rehearsal reveals the schedule of a real participant.
enum class Draws { people, rehearsal };

/// The random input of a participant's schedule. The participant's secret is derived from the
/// station's. The orders of methods come in blocks, separate for each group: a block has every row
/// of the Williams design once, in an order drawn from the station's secret. The orders at a
/// station therefore stay balanced, but cannot be predicted without the secret. The order of
/// methods is the same at all visits.
/// \param visit  from 1
/// \throws UsageError if the number is not the station's, or the study has no such visit
[[nodiscard]] ScheduleDraw draw_for(const Study& study, const Station& station, int enrolment,
                                    Draws draws, int visit = 1);

/// The group of an enrolment number, from 0. Groups are assigned in blocks that contain each group
/// once. If groups are open, a block contains each once or twice at random, so that past
/// assignments do not reveal the next one.
/// \return empty if the study has no groups, or the number is another station's
[[nodiscard]] std::optional<int> group_for(const Study& study, const Station& station,
                                           int enrolment, Draws draws);

/// The number of different orders of methods, which are balanced over participants.
[[nodiscard]] int method_orders(const Study& study);

/// The randomisation block of an enrolment number's order of methods. Numbers of the same block
/// have different orders, each equally likely. Block numbers are unique over stations and groups,
/// >= 0.
/// \return -1 if no station has the number
[[nodiscard]] int order_block_of(const Study& study, std::span<const Station> stations,
                                 int enrolment, Draws draws = Draws::people);

/// Makes stations without numbers and secrets.
/// \param names  1 to kMaxStations
/// \throws UsageError if there are too few or too many names, a name is not 1 to 32 of
///   [0-9A-Za-z+-_], or a name occurs twice
[[nodiscard]] std::vector<Station> stations_named(std::span<const std::string> names);

/// The total of enrolment numbers of all stations. The numbers are 1 to this total.
[[nodiscard]] int enrolment_count(std::span<const Station> stations) noexcept;

/// Assigns the next numbers until all stations together have `participants`. Each station gets
/// consecutive numbers, such that totals differ as little as possible.
/// \param participants  from enrolment_count(stations) to kMaxEnrolments
/// \throws std::invalid_argument if there are no stations or `participants` is out of range
void assign_enrolments(std::span<Station> stations, int participants);

/// The first of the station's numbers that is not in use.
/// \throws StudyError with the remedy if all are in use
[[nodiscard]] int next_enrolment_of(const Station& station, const std::set<int>& taken);

/// The station that a number belongs to, or null.
[[nodiscard]] const Station* station_of(std::span<const Station> stations, int enrolment) noexcept;

}  // namespace touchtrial::study
