#include "event_tables.hpp"

#include "analysis/exports/export_tables.hpp"
#include "analysis/outcomes/incidents.hpp"
#include "record/event_kinds.hpp"

#include <span>
#include <string_view>

namespace touchtrial {
namespace {

using record::ListedMember;

class Table {
 public:
  void add_kind(const record::EventKindRow& row) {
    const std::string key = row.details.in_safety_record ? " (safety key)" : "";
    add("`" + std::string(row.name) + "`" + key, "", "", "", row.meaning);
    for (const ListedMember& one : record::members_of(row.body)) {
      const bool is_text = one.member.key == "text" && !row.details.text.empty();
      add_member("", one, one.member.note.sealed ? "sealed" : "",
                 is_text ? row.details.text : one.member.meaning);
    }
    if (row.details.secret != nullptr) {
      for (const ListedMember& one : record::members_of(row.details.secret)) {
        add_member("", one, "secret", one.member.meaning);
      }
    }
    if (!row.details.secret_description.empty())
      add("", "", "", "secret", row.details.secret_description);
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void add_member(const std::string& before, const ListedMember& one, std::string_view where,
                  std::string_view meaning) {
    const std::string name = before + std::string(one.member.key);
    add("", "`" + name + "`" + (one.member.optional ? "*" : ""), one.type, where, meaning);
    for (const ListedMember& inner : one.within) {
      add_member(name + ".", inner, where, inner.member.meaning);
    }
  }
  void add(const std::string& kind, const std::string& member, const std::string& type,
           std::string_view where, std::string_view meaning) {
    for (const std::string_view cell : {std::string_view(kind), std::string_view(member),
                                        std::string_view(type), where, meaning}) {
      text_ += "| " + std::string(cell) + (cell.empty() ? "" : " ");
    }
    text_ += "|\n";
  }

  std::string text_ =
      "| kind | member | type and range | where | meaning |\n| --- | --- | --- | --- | --- |\n";
};

std::string row_of_file(const std::string& file, std::span<const record::EventKind> kinds) {
  std::string names;
  for (const record::EventKind kind : kinds) {
    names += (names.empty() ? "`" : ", `") + std::string(name_of(kind)) + "`";
  }
  return "| `" + file + "` | " + names + " |\n";
}

}  // namespace

std::string table_of_exported_events() {
  return "| file | kinds of events |\n| --- | --- |\n" +
         row_of_file("events.csv", analysis::kinds_in_events_csv()) +
         row_of_file("incidents.csv", analysis::incident_kinds());
}

std::string table_of_events(bool on_file_chain) {
  Table table;
  for (const record::EventKindRow& row : record::event_kinds()) {
    if (belongs_to_file_chain(row.kind) == on_file_chain) table.add_kind(row);
  }
  return table.text();
}

}  // namespace touchtrial
