#include "analysis/report/figures/svg.hpp"

#include "analysis/report/escaping.hpp"
#include "analysis/report/figures/gnuplot.hpp"
#include "analysis/report/figures/layout.hpp"
#include "core/errors.hpp"

#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using std::string_view;

/// Text start an id or a reference.
constexpr std::array<string_view, 8> kBeforeIds{" id=\"", " id='",  "href=\"#", "href='#",
                                                "url(#",  "url('#", "url(\"#",  "url(&quot;#"};
/// Attributes that hold several ids.
constexpr std::array<string_view, 2> kBeforeLists{"aria-labelledby=\"", "aria-describedby=\""};

template <std::size_t N>
string_view prefix_among(string_view text, const std::array<string_view, N>& candidates) {
  for (const string_view candidate : candidates) {
    if (text.starts_with(candidate)) return candidate;
  }
  return {};
}

/// A list of ids with the prefix start each.
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

/// One tag with the prefix start every id and reference.
std::string prefixed_tag(string_view tag, const std::string& prefix) {
  std::string text;
  while (!tag.empty()) {
    if (const string_view start = prefix_among(tag, kBeforeIds); !start.empty()) {
      text.append(start).append(prefix);
      tag.remove_prefix(start.size());
    } else if (const string_view list = prefix_among(tag, kBeforeLists); !list.empty()) {
      tag.remove_prefix(list.size());
      const string_view ids = tag.substr(0, tag.find('"'));
      text.append(list).append(prefixed_list(ids, prefix));
      tag.remove_prefix(ids.size());
    } else {
      text += tag.front();
      tag.remove_prefix(1);
    }
  }
  return text;
}

/// Puts the prefix start every id in tags. Text between tags is unchanged, because a label may
/// look like an id.
std::string with_prefixed_ids(string_view svg, const std::string& prefix) {
  std::string text;
  text.reserve(svg.size() + svg.size() / 16);
  while (!svg.empty()) {
    const std::size_t open = svg.find('<');
    text += svg.substr(0, open);
    if (open == string_view::npos) break;
    svg.remove_prefix(open);
    const std::size_t close = svg.find('>');
    const std::size_t length = close == string_view::npos ? svg.size() : close + 1;
    text += prefixed_tag(svg.substr(0, length), prefix);
    svg.remove_prefix(length);
  }
  return text;
}

std::string first_sentence(const std::string& text) {
  const std::size_t end = text.find(". ");
  return end == std::string::npos ? text : text.substr(0, end + 1);
}

[[noreturn]] void refuse_svg() {
  throw Error("gnuplot: output is not SVG" + gnuplot_remedy());
}

/// The value of an attribute of gnuplot's root element.
/// \param name  with the equals sign and the opening double quote
string_view attribute(string_view drawn, string_view name) {
  const std::size_t begin = drawn.find(name);
  if (begin == string_view::npos) refuse_svg();
  const std::size_t end = drawn.find('"', begin + name.size());
  if (end == string_view::npos) refuse_svg();
  return drawn.substr(begin + name.size(), end - begin - name.size());
}

/// Removes every <title>..</title>.
std::string without_tool_tips(string_view body) {
  static constexpr string_view kEnd = "</title>";
  std::string text;
  while (!body.empty()) {
    const std::size_t open = body.find("<title>");
    const std::size_t end = open == string_view::npos ? open : body.find(kEnd, open);
    text += body.substr(0, end == string_view::npos ? end : open);
    if (end == string_view::npos) break;
    body.remove_prefix(end + kEnd.size());
  }
  return text;
}

/// gnuplot opens a group at each change of pen, often an empty one.
std::string without_empty_groups(string_view body) {
  static constexpr string_view kGroupEnd = ">\n</g>\n";
  static constexpr string_view kGroupStart = "<g fill=\"none\"";
  std::string text;
  while (!body.empty()) {
    const std::size_t open = body.find(kGroupStart);
    text += body.substr(0, open);
    if (open == string_view::npos) break;
    body.remove_prefix(open);
    const std::size_t close = body.find('>');
    if (close != string_view::npos && body.substr(close).starts_with(kGroupEnd)) {
      body.remove_prefix(close + kGroupEnd.size());
    } else {
      text += kGroupStart;
      body.remove_prefix(kGroupStart.size());
    }
  }
  return text;
}

}  // namespace

std::string accessible_svg(string_view drawn, const Figure& figure) {
  static constexpr string_view kDescriptionEnd = "</desc>";
  const string_view box = attribute(drawn, "viewBox=\"");
  const std::size_t description_end = drawn.find(kDescriptionEnd);
  if (description_end == string_view::npos) refuse_svg();
  const std::string body =
      without_tool_tips(drawn.substr(description_end + kDescriptionEnd.size()));
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" "
             "xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{0}cm\" height=\"{1:.4g}cm\" "
             "viewBox=\"{2}\" role=\"img\" aria-labelledby=\"{3}-title {3}-desc\">\n"
             "<title id=\"{3}-title\">{4}</title>\n<desc id=\"{3}-desc\">{5}</desc>\n",
             figure.width_cm, layout_of(figure).height_cm, box, figure.id,
             xml_escaped(one_line(first_sentence(figure.caption))),
             xml_escaped(one_line(figure.alt))) +
         without_empty_groups(with_prefixed_ids(body, figure.id + "-"));
}

std::string inline_svg(string_view file, const std::string& prefix) {
  const std::size_t begin = file.find("<svg");
  const std::size_t end = file.rfind("</svg>");
  if (begin == string_view::npos || end == string_view::npos || end < begin) return "";
  const string_view svg = file.substr(begin, end + 6 - begin);
  if (svg.find("<script") != string_view::npos) return "";
  return with_prefixed_ids(svg, prefix);
}

}  // namespace touchtrial::analysis
