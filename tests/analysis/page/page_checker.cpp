#include "analysis/page/page_checker.hpp"

#include <cctype>
#include <map>
#include <set>
#include <string_view>

namespace touchtrial {
namespace {

const std::set<std::string> kVoid = {"meta", "br", "img", "hr", "link", "input", "col"};
const std::set<std::string> kKnownAddresses = {"http://www.w3.org/2000/svg",
                                               "http://www.w3.org/1999/xlink"};

using Attributes = std::map<std::string, std::string>;

struct Tag {
  std::string name;
  bool closing = false;
  bool self_closing = false;
  Attributes attributes;
};

/// One table while it is read.
struct OpenTable {
  bool caption = false;
  bool header = false;
  std::size_t columns = 0;
  std::size_t cells = 0;
};

struct Checker {
  std::string_view rest;
  std::vector<std::string> faults{};
  std::vector<std::string> open{};
  std::set<std::string> ids{};
  std::vector<std::string> wanted{};
  std::vector<OpenTable> tables{};
  bool figcaption = false;
  int heading = 0;
  int h1 = 0;
};

void complain(Checker& checker, const std::string& what) {
  checker.faults.push_back(what);
}

std::string attribute_name(std::string_view& rest) {
  std::size_t end = 0;
  while (end < rest.size() && rest[end] != '=' && rest[end] != '>' && rest[end] != '/' &&
         std::isspace(static_cast<unsigned char>(rest[end])) == 0) {
    ++end;
  }
  std::string name(rest.substr(0, end));
  rest.remove_prefix(end);
  return name;
}

std::string attribute_value(std::string_view& rest) {
  if (rest.empty() || rest.front() != '=') return "";
  rest.remove_prefix(1);
  if (rest.empty() || (rest.front() != '"' && rest.front() != '\'')) return "(unquoted)";
  const char quote = rest.front();
  const std::size_t end = rest.find(quote, 1);
  if (end == std::string_view::npos) return "(unclosed)";
  std::string value(rest.substr(1, end - 1));
  rest.remove_prefix(end + 1);
  return value;
}

/// The tag that `rest` begins with; `rest` moves behind it.
Tag next_tag(std::string_view& rest) {
  Tag tag;
  rest.remove_prefix(1);
  if (!rest.empty() && rest.front() == '/') {
    tag.closing = true;
    rest.remove_prefix(1);
  }
  tag.name = attribute_name(rest);
  while (!rest.empty() && rest.front() != '>') {
    if (rest.front() == '/') {
      tag.self_closing = true;
      rest.remove_prefix(1);
    } else if (std::isspace(static_cast<unsigned char>(rest.front())) != 0) {
      rest.remove_prefix(1);
    } else {
      const std::string name = attribute_name(rest);
      tag.attributes[name] = attribute_value(rest);
      if (name.empty()) break;
    }
  }
  if (!rest.empty()) rest.remove_prefix(1);
  return tag;
}

bool has(const Tag& tag, const std::string& name) {
  return tag.attributes.contains(name) && !tag.attributes.at(name).empty();
}

void want_ids(Checker& checker, const std::string& list) {
  std::string word;
  for (const char c : list + " ") {
    if (c != ' ') {
      word += c;
    } else if (!word.empty()) {
      checker.wanted.push_back(word);
      word.clear();
    }
  }
}

void check_address(Checker& checker, const std::string& name, const std::string& value) {
  if (value.find("://") != std::string::npos && !kKnownAddresses.contains(value)) {
    complain(checker, "an address outside the page: " + value);
  }
  if (name == "href" || name == "xlink:href" || name == "src") {
    if (value.starts_with("#")) {
      checker.wanted.push_back(value.substr(1));
    } else if (!value.starts_with("data:")) {
      complain(checker, "a reference to something outside the page: " + value);
    }
  }
}

void check_attributes(Checker& checker, const Tag& tag) {
  for (const auto& [name, value] : tag.attributes) {
    check_address(checker, name, value);
    if (name.starts_with("on")) complain(checker, "a handler: " + name);
    if (name == "id" && !checker.ids.insert(value).second) complain(checker, "twice: id " + value);
    if (name == "aria-labelledby" || name == "aria-describedby") want_ids(checker, value);
    if (value == "(unquoted)" || value == "(unclosed)") {
      complain(checker, "attribute " + name + " " + value);
    }
  }
}

void check_heading(Checker& checker, int level) {
  if (level == 1) ++checker.h1;
  if (level > checker.heading + 1) complain(checker, "a heading skips a level");
  checker.heading = level;
}

void check_cell(Checker& checker, const Tag& tag) {
  if (checker.tables.empty()) return complain(checker, "a cell without a table");
  OpenTable& table = checker.tables.back();
  ++table.cells;
  if (tag.name != "th") return;
  table.header = true;
  if (!has(tag, "scope")) complain(checker, "a header cell without a scope");
}

void end_row(Checker& checker) {
  if (checker.tables.empty()) return;
  OpenTable& table = checker.tables.back();
  if (table.columns == 0) table.columns = table.cells;
  if (table.cells != table.columns) complain(checker, "a row of another length");
  table.cells = 0;
}

void check_opening(Checker& checker, const Tag& tag) {
  const std::string& name = tag.name;
  if (name == "html" && !has(tag, "lang")) complain(checker, "no language");
  if (name == "script" || name == "link" || name == "iframe" || name == "object") {
    complain(checker, "element " + name);
  }
  if (name.size() == 2 && name[0] == 'h' && name[1] >= '1' && name[1] <= '6') {
    check_heading(checker, name[1] - '0');
  }
  if (name == "table") checker.tables.emplace_back();
  if (name == "caption" && !checker.tables.empty()) checker.tables.back().caption = true;
  if (name == "th" || name == "td") check_cell(checker, tag);
  if (name == "figure") checker.figcaption = false;
  if (name == "figcaption") checker.figcaption = true;
  if (name == "img" && !has(tag, "alt")) complain(checker, "a picture without words");
  const auto role = tag.attributes.find("role");
  if (role == tag.attributes.end()) return;
  if (role->second == "img" && !has(tag, "aria-label"))
    complain(checker, "a picture without words");
  if (role->second == "region" && !has(tag, "tabindex"))
    complain(checker, "out of reach by keyboard");
}

void check_closing(Checker& checker, const std::string& name) {
  if (name == "tr") end_row(checker);
  if (name == "table" && !checker.tables.empty()) {
    if (!checker.tables.back().caption) complain(checker, "a table without a caption");
    if (!checker.tables.back().header) complain(checker, "a table without headers");
    checker.tables.pop_back();
  }
  if (name == "figure" && !checker.figcaption) complain(checker, "a figure without a caption");
}

void take_tag(Checker& checker) {
  const Tag tag = next_tag(checker.rest);
  if (tag.closing) {
    if (checker.open.empty() || checker.open.back() != tag.name) {
      complain(checker, "</" + tag.name + "> closes " +
                            (checker.open.empty() ? "nothing" : checker.open.back()));
    } else {
      checker.open.pop_back();
    }
    return check_closing(checker, tag.name);
  }
  check_attributes(checker, tag);
  check_opening(checker, tag);
  if (tag.self_closing || kVoid.contains(tag.name)) return;
  checker.open.push_back(tag.name);
  if (tag.name == "style") {
    const std::string_view style = checker.rest.substr(0, checker.rest.find("</style>"));
    if (style.find("url(") != std::string_view::npos ||
        style.find("@import") != std::string_view::npos) {
      complain(checker, "a style from outside");
    }
    checker.rest.remove_prefix(style.size());
  }
}

void finish(Checker& checker) {
  for (const std::string& name : checker.open) complain(checker, "not closed: " + name);
  for (const std::string& id : checker.wanted) {
    if (!checker.ids.contains(id)) complain(checker, "leads nowhere: #" + id);
  }
  if (checker.h1 != 1) complain(checker, "not one h1");
}

}  // namespace

std::vector<std::string> faults_of_page(const std::string& html) {
  Checker checker{html};
  if (!html.starts_with("<!doctype html>\n")) complain(checker, "no doctype");
  checker.rest.remove_prefix(std::min(checker.rest.size(), checker.rest.find('>') + 1));
  while (!checker.rest.empty()) {
    const std::size_t at = checker.rest.find('<');
    const std::string_view text = checker.rest.substr(0, at);
    if (text.find('>') != std::string_view::npos) complain(checker, "a bare > in text");
    if (at == std::string_view::npos) break;
    checker.rest.remove_prefix(at);
    take_tag(checker);
  }
  finish(checker);
  return checker.faults;
}

}  // namespace touchtrial
