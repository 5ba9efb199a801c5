#include "analysis/page/inline_svg.hpp"

#include <array>

namespace touchtrial::analysis {
namespace {

using std::string_view;

/// What an id or a reference to one stands after.
constexpr std::array<string_view, 8> kBeforeIds{" id=\"", " id='",  "href=\"#", "href='#",
                                                "url(#",  "url('#", "url(\"#",  "url(&quot;#"};
/// Attributes that hold several ids.
constexpr std::array<string_view, 2> kBeforeLists{"aria-labelledby=\"", "aria-describedby=\""};

template <std::size_t N>
string_view beginning_of(string_view text, const std::array<string_view, N>& candidates) {
  for (const string_view one : candidates) {
    if (text.starts_with(one)) return one;
  }
  return {};
}

/// Every word of a list of ids, begun with the prefix.
std::string prefixed_list(string_view list, const std::string& prefix) {
  std::string all;
  bool at_begin = true;
  for (const char c : list) {
    if (at_begin && c != ' ') all += prefix;
    at_begin = c == ' ';
    all += c;
  }
  return all;
}

std::string with_prefix(string_view svg, const std::string& prefix) {
  std::string text;
  text.reserve(svg.size() + svg.size() / 16);
  while (!svg.empty()) {
    if (const string_view before = beginning_of(svg, kBeforeIds); !before.empty()) {
      text.append(before).append(prefix);
      svg.remove_prefix(before.size());
    } else if (const string_view list = beginning_of(svg, kBeforeLists); !list.empty()) {
      svg.remove_prefix(list.size());
      const string_view ids = svg.substr(0, svg.find('"'));
      text.append(list).append(prefixed_list(ids, prefix));
      svg.remove_prefix(ids.size());
    } else {
      text += svg.front();
      svg.remove_prefix(1);
    }
  }
  return text;
}

}  // namespace

std::string inline_svg(string_view file, const std::string& prefix) {
  const std::size_t begin = file.find("<svg");
  const std::size_t end = file.rfind("</svg>");
  if (begin == string_view::npos || end == string_view::npos || end < begin) return "";
  const string_view svg = file.substr(begin, end + 6 - begin);
  if (svg.find("<script") != string_view::npos) return "";
  return with_prefix(svg, prefix);
}

}  // namespace touchtrial::analysis
