#include "event_tables.hpp"

#include "record/event_kinds.hpp"

#include <string_view>

namespace touchtrial {
namespace {

using record::ListedMember;

class Table {
 public:
  void add_kind(const record::EventKindRow& row) {
    const std::string key = row.more.in_safety_record ? " (safety key)" : "";
    add("`" + std::string(row.name) + "`" + key, "", "", "", row.meaning);
    for (const ListedMember& one : record::members_of(row.body)) {
      const bool is_text = one.member.key == "text" && !row.more.text.empty();
      add_member("", one, one.member.note.sealed ? "sealed" : "",
                 is_text ? row.more.text : one.member.meaning);
    }
    if (row.more.secret != nullptr) {
      for (const ListedMember& one : record::members_of(row.more.secret)) {
        add_member("", one, "secret", one.member.meaning);
      }
    }
    if (!row.more.secret_in_words.empty()) add("", "", "", "secret", row.more.secret_in_words);
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

}  // namespace

std::string table_of_events(bool on_file_chain) {
  Table table;
  for (const record::EventKindRow& row : record::event_kinds()) {
    if (belongs_to_file_chain(row.kind) == on_file_chain) table.add_kind(row);
  }
  return table.text();
}

}  // namespace touchtrial
