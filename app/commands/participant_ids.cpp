#include "app/commands/participant_ids.hpp"

#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/nearest_name.hpp"
#include "core/text.hpp"
#include "record/personal_data.hpp"
#include "record/study_store.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

/// The parts of an id: "P07" has the prefix "P" and the number 7, in two digits.
struct IdParts {
  std::string_view prefix;
  std::optional<std::int64_t> number{};
  std::size_t digits = 0;
};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

IdParts parts_of(std::string_view id) {
  const std::size_t prefix_end = id.find_last_not_of("0123456789");
  const std::size_t begin = prefix_end == std::string_view::npos ? 0 : prefix_end + 1;
  return {id.substr(0, begin), number_in<std::int64_t>(id.substr(begin)), id.size() - begin};
}

/// Whether two ids differ in a single digit: "P07" and "P08" do, "P07" and "P70" do not.
bool differ_in_one_digit(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  int differences = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    if (!is_digit(a[i]) || !is_digit(b[i])) return false;
    ++differences;
  }
  return differences == 1;
}

bool are_alike(const std::string& a, const std::string& b) {
  const IdParts first = parts_of(a);
  const IdParts second = parts_of(b);
  const bool is_same_number = first.number && first.number == second.number;
  if (is_same_number && edit_distance(first.prefix, second.prefix) == 0) return true;
  return edit_distance(a, b) <= 1 && !differ_in_one_digit(a, b);
}

}  // namespace

std::optional<std::string> next_id(const std::vector<std::string>& ids) {
  if (ids.empty()) return "P01";
  const IdParts last_parts = parts_of(ids.back());
  if (!last_parts.number) return std::nullopt;
  std::int64_t largest = *last_parts.number;
  for (const std::string& id : ids) {
    const IdParts parts = parts_of(id);
    if (parts.prefix == last_parts.prefix) largest = std::max(largest, parts.number.value_or(0));
  }
  return fmt::format("{}{:0{}}", last_parts.prefix, largest + 1, last_parts.digits);
}

std::optional<std::string> likely_id(const std::string& id, const std::vector<std::string>& ids) {
  if (std::ranges::count(ids, id) > 0 || id == next_id(ids)) return std::nullopt;
  const auto similar_id = std::ranges::find_if(
      ids, [&](const std::string& known_id) { return are_alike(id, known_id); });
  if (similar_id == ids.end()) return std::nullopt;
  return *similar_id;
}

std::vector<std::string> known_ids(const std::filesystem::path& database) {
  std::vector<std::string> ids;
  const auto add = [&ids](const std::string& id) {
    if (!id.empty() && std::ranges::count(ids, id) == 0) ids.push_back(id);
  };
  try {
    if (path_exists(database)) {
      const auto store = record::StudyStore::open(database, record::StudyStore::Access::read_only);
      for (const record::SessionRow& row : store.sessions()) {
        for (const std::string& id : {row.participant, row.replaced_by}) add(id);
      }
    }
  } catch (const StoreError&) {
    // Reported by the command that writes the database; a consent is recorded regardless.
  }
  try {
    for (const record::PersonalRecord& consent : consents_beside(database)) {
      add(consent.participant);
    }
  } catch (const Error&) {
    // The command that records the consent prints a warning.
  }
  return ids;
}

void confirm_id(const std::string& command, const std::filesystem::path& database,
                const std::string& id, bool yes) {
  const auto similar_id = likely_id(id, known_ids(database));
  if (!similar_id) return;
  confirm(command + ": participant " + id + " has neither a session nor a consent, and " +
              *similar_id + " is known; give --participant " + *similar_id +
              " if you mean that participant",
          yes);
}

}  // namespace touchtrial::app
