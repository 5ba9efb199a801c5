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

/// "P07": "P" and 7, in two digits.
struct IdParts {
  std::string_view before;
  std::optional<std::int64_t> number{};
  std::size_t digits = 0;
};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

IdParts parts_of(std::string_view id) {
  const std::size_t last = id.find_last_not_of("0123456789");
  const std::size_t begin = last == std::string_view::npos ? 0 : last + 1;
  return {id.substr(0, begin), number_in<std::int64_t>(id.substr(begin)), id.size() - begin};
}

/// "P07" and "P08", but not "P07" and "P70".
bool differ_in_one_digit(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  int others = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    if (!is_digit(a[i]) || !is_digit(b[i])) return false;
    ++others;
  }
  return others == 1;
}

bool are_alike(const std::string& a, const std::string& b) {
  const IdParts one = parts_of(a);
  const IdParts other = parts_of(b);
  if (one.number && one.number == other.number && edit_distance(one.before, other.before) == 0) {
    return true;
  }
  return edit_distance(a, b) <= 1 && !differ_in_one_digit(a, b);
}

}  // namespace

std::optional<std::string> next_id(const std::vector<std::string>& known) {
  if (known.empty()) return "P01";
  const IdParts last = parts_of(known.back());
  if (!last.number) return std::nullopt;
  std::int64_t largest = *last.number;
  for (const std::string& id : known) {
    const IdParts one = parts_of(id);
    if (one.before == last.before) largest = std::max(largest, one.number.value_or(0));
  }
  return fmt::format("{}{:0{}}", last.before, largest + 1, last.digits);
}

std::optional<std::string> likely_id(const std::string& id, const std::vector<std::string>& known) {
  if (std::ranges::count(known, id) > 0 || id == next_id(known)) return std::nullopt;
  const auto found =
      std::ranges::find_if(known, [&](const std::string& one) { return are_alike(id, one); });
  if (found == known.end()) return std::nullopt;
  return *found;
}

std::vector<std::string> known_ids(const std::filesystem::path& database) {
  std::vector<std::string> ids;
  const auto add = [&ids](const std::string& id) {
    if (!id.empty() && std::ranges::count(ids, id) == 0) ids.push_back(id);
  };
  try {
    if (is_there(database)) {
      const auto store = record::StudyStore::open(database, record::StudyStore::Access::read_only);
      for (const record::SessionRow& row : store.sessions()) {
        for (const std::string& id : {row.participant, row.replaced_by}) add(id);
      }
    }
  } catch (const StoreError&) {
    // The command that writes the database reports the error; consent is recorded regardless.
  }
  try {
    for (const record::PersonalRecord& one : consents_beside(database)) add(one.participant);
  } catch (const Error&) {
    // A new consent only prints a warning.
  }
  return ids;
}

void confirm_id(const std::string& command, const std::filesystem::path& database,
                const std::string& id, bool yes) {
  const auto meant = likely_id(id, known_ids(database));
  if (!meant) return;
  confirm(command + ": participant " + id + " has neither a session nor a consent, and " + *meant +
              " is known; give --participant " + *meant + " if that is who is meant",
          yes);
}

}  // namespace touchtrial::app
