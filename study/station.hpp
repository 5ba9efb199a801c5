/// \file The stations of a study: the enrolment numbers that each one hands out, and the secret
/// that decides the schedules of its participants. Rules: docs/several-stations.md.
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
/// The only station of a study that nobody divided; all enrolment numbers are its own.
inline constexpr const char* kOnlyStation = "main";

/// One station.
struct Station {
  std::string name;  ///< unique in its study; of the characters of participant ids
  std::vector<EnrolmentRange> ranges;  ///< its numbers, in the order in which it got them
  SecretKey secret{};                  ///< decides its schedules; derived from the study's key

  [[nodiscard]] int size() const noexcept;
  /// The place of a number among the station's numbers, from 0; empty if it is another's.
  [[nodiscard]] std::optional<int> place_of(int enrolment) const noexcept;
  friend bool operator==(const Station&, const Station&) = default;
};

/// Pilots and simulated participants draw from a stream of their own, so that no rehearsal shows a
/// schedule that a person will get.
enum class Draws { people, rehearsal };

/// What the schedule of a participant is drawn from. The participant's secret is derived from the
/// station's. The orders of methods come in blocks: each block has every row of the Williams design
/// once, in an order drawn from the station's secret, so that a station's numbers stay balanced and
/// nobody without the secret can tell a participant's order. With groups, the blocks are of each
/// group's numbers. The order of methods is the same at all visits.
/// \param visit  from 1
/// \throws UsageError if the number is not the station's, or the study has no such visit
[[nodiscard]] ScheduleDraw draw_for(const Study& study, const Station& station, int enrolment,
                                    Draws draws, int visit = 1);

/// The group that a station deals a number into, from 0. Groups are dealt in blocks that have each
/// group once, or, if groups are open, once or twice at random, so that what was dealt does not
/// tell what comes.
/// \return empty if the study has no groups, or the number is another station's
[[nodiscard]] std::optional<int> group_for(const Study& study, const Station& station,
                                           int enrolment, Draws draws);

/// The number of different orders of methods among which participants are balanced.
[[nodiscard]] int method_orders(const Study& study);

/// The block in which an enrolment number's order of methods was dealt. Numbers of the same block
/// have different orders, each equally likely; blocks of all stations and groups have different
/// numbers, >= 0.
/// \return -1 if the number is no station's
[[nodiscard]] int order_block_of(const Study& study, std::span<const Station> stations,
                                 int enrolment, Draws draws = Draws::people);

/// Stations without numbers and secrets.
/// \param names  1 to kMaxStations
/// \throws UsageError if there are too few or too many names, a name is not 1 to 32 of
///   [0-9A-Za-z+-_], or a name occurs twice
[[nodiscard]] std::vector<Station> stations_named(std::span<const std::string> names);

/// How many numbers all stations have together. The numbers are 1 to this.
[[nodiscard]] int enrolments_of(std::span<const Station> stations) noexcept;

/// Hands out the next numbers until all stations together have `participants`. Each station gets
/// consecutive numbers, so many that the totals differ as little as possible.
/// \param participants  from enrolments_of(stations) to kMaxEnrolments
/// \throws std::invalid_argument if there are no stations or `participants` is out of range
void hand_out_enrolments(std::span<Station> stations, int participants);

/// The first of the station's numbers that is not taken.
/// \throws StudyError with the remedy if all are taken
[[nodiscard]] int next_enrolment_of(const Station& station, const std::set<int>& taken);

/// The station that a number belongs to; null if it is nobody's.
[[nodiscard]] const Station* station_of(std::span<const Station> stations, int enrolment) noexcept;

}  // namespace touchtrial::study
