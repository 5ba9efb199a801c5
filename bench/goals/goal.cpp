#include "bench/goals/goal.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::bench {
namespace {

constexpr std::size_t kColumns = 10;
using Line = std::array<std::string, kColumns>;

std::string time_text(double us) {
  if (std::isnan(us)) return {};
  if (us < 1.0) return fmt::format("{:.1f} ns", 1e3 * us);
  if (us < 1e4) return fmt::format("{:.{}f} us", us, us < 100.0 ? 1 : 0);
  if (us < 1e6) return fmt::format("{:.{}f} ms", 1e-3 * us, us < 1e5 ? 1 : 0);
  return fmt::format("{:.2f} s", 1e-6 * us);
}

std::string error_text(double error, const std::string& unit) {
  if (std::isnan(error)) return {};
  return fmt::format("{:.1e}{}{}", error, unit.empty() ? "" : " ", unit);
}

std::string target_text(const GoalResult& result) {
  if (!has_target(result)) return {};
  switch (result.limit) {
    case Limit::time_us:
      return "<= " + time_text(result.target);
    case Limit::of_bound:
      return fmt::format("<= {:g} of bound", result.target);
    case Limit::error:
      return fmt::format("error <= {:.0e}", result.target);
    case Limit::count:
      return fmt::format("<= {:g} {}", result.target, result.count_unit);
    case Limit::ratio:
      break;
  }
  return fmt::format("<= {:g}", result.target);
}

std::string met_text(const GoalResult& result) {
  if (!has_target(result)) return {};
  return is_met(result) ? "yes" : "**no**";
}

std::string ours_text(const GoalResult& result) {
  const std::string time = time_text(result.ours_us);
  if (std::isnan(result.count)) return time;
  const std::string count = fmt::format("{:g} {}", result.count, result.count_unit);
  return time.empty() ? count : time + ", " + count;
}

std::string ratio_text(double ratio, int digits) {
  return std::isnan(ratio) ? std::string() : fmt::format("{:.{}f}", ratio, digits);
}

Line line_of(const GoalResult& result) {
  return {result.goal,
          ours_text(result),
          result.peer,
          time_text(result.peer_us),
          ratio_text(result.ratio, 3),
          result.bound.empty() ? "" : result.bound + ", " + time_text(result.bound_us),
          ratio_text(result.of_bound, 2),
          target_text(result),
          error_text(result.error, result.error_unit),
          met_text(result)};
}

std::string joined(const Line& line, const std::array<std::size_t, kColumns>& widths) {
  std::string text = "|";
  for (std::size_t i = 0; i < kColumns; ++i) text += fmt::format(" {:<{}} |", line[i], widths[i]);
  return text + "\n";
}

}  // namespace

double limited_number(const GoalResult& result) noexcept {
  switch (result.limit) {
    case Limit::time_us:
      return result.ours_us;
    case Limit::of_bound:
      return result.of_bound;
    case Limit::error:
      return result.error;
    case Limit::count:
      return result.count;
    case Limit::ratio:
      break;
  }
  return result.ratio;
}

bool has_target(const GoalResult& result) noexcept {
  return !std::isnan(result.target);
}

bool is_met(const GoalResult& result) noexcept {
  return limited_number(result) <= result.target;
}

std::vector<std::string> slower_than_committed(const std::vector<GoalResult>& results,
                                               std::string_view committed) {
  constexpr double kAllowed = 1.1;
  std::vector<std::string> lines;
  try {
    const auto earlier = nlohmann::json::parse(committed).at("goals");
    for (const GoalResult& result : results) {
      const auto same = std::ranges::find_if(earlier, [&](const nlohmann::json& one) {
        return one.at("goal") == result.goal && one.at("peer").is_null() == result.peer.empty() &&
               (result.peer.empty() || one.at("peer") == result.peer);
      });
      if (same == earlier.end()) continue;
      const auto compare = [&](const char* key, const std::string& beside, double now) {
        const auto before = same->find(key);
        if (before == same->end() || before->is_null() || std::isnan(now)) return;
        if (now <= kAllowed * before->get<double>()) return;
        lines.push_back(fmt::format("{}: {:.3f} of {}, and {:.3f} in the committed results",
                                    result.goal, now, beside, before->get<double>()));
      };
      compare("ratio", result.peer, result.ratio);
      compare("of_bound", "the bound", result.of_bound);
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(std::string("the committed results are not the benchmark's JSON: ") + error.what());
  }
  return lines;
}

std::string goals_table(const std::vector<GoalResult>& results) {
  std::vector<Line> lines = {{"goal", "ours", "peer", "peer's time", "ratio", "bound", "of bound",
                              "target", "our error", "met"}};
  for (const GoalResult& result : results) lines.push_back(line_of(result));
  std::array<std::size_t, kColumns> widths{};
  for (const Line& line : lines) {
    for (std::size_t i = 0; i < kColumns; ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  Line rule;
  for (std::size_t i = 0; i < kColumns; ++i) rule[i] = std::string(widths[i], '-');
  lines.insert(lines.begin() + 1, rule);
  std::string table;
  for (const Line& line : lines) table += joined(line, widths);
  return table;
}

}  // namespace touchtrial::bench
