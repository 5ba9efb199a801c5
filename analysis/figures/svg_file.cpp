#include "analysis/figures/svg_file.hpp"

#include "core/errors.hpp"

#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : one_line(text)) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

/// Up to the end of the first sentence, with its full stop.
std::string first_sentence(const std::string& text) {
  const std::size_t end = text.find(". ");
  return end == std::string::npos ? text : text.substr(0, end + 1);
}

/// The value of an attribute of gnuplot's root element, which is in double quotes.
std::string_view attribute(std::string_view drawn, std::string_view name) {
  const std::size_t begin = drawn.find(name);
  const std::size_t end =
      begin == std::string_view::npos ? begin : drawn.find('"', begin + name.size());
  if (end == std::string_view::npos) {
    throw Error("gnuplot: printed no SVG; try version 5.2 or later");
  }
  return drawn.substr(begin + name.size(), end - begin - name.size());
}

/// One tag with the figure's id before every id that it gives or refers to.
std::string with_own_ids(std::string_view tag, const std::string& id) {
  static constexpr std::array<std::string_view, 6> kBefore = {
      " id='", " id=\"", "xlink:href='#", "xlink:href=\"#", "url(#", "url('#"};
  std::string own(tag);
  for (const std::string_view before : kBefore) {
    for (std::size_t at = own.find(before); at != std::string::npos;
         at = own.find(before, at + before.size() + id.size())) {
      own.insert(at + before.size(), id + "-");
    }
  }
  return own;
}

/// Without <title>..</title>; texts are copied, for a label may look like markup of an id.
std::string body_of(std::string_view rest, const std::string& id) {
  static constexpr std::string_view kEnd = "</title>";
  std::string body;
  while (!rest.empty()) {
    const std::size_t open = rest.find('<');
    body += rest.substr(0, open);
    if (open == std::string_view::npos) break;
    rest.remove_prefix(open);
    if (rest.starts_with("<title>") && rest.find(kEnd) != std::string_view::npos) {
      rest.remove_prefix(rest.find(kEnd) + kEnd.size());
      continue;
    }
    const std::size_t close = rest.find('>');
    body += with_own_ids(rest.substr(0, close == std::string_view::npos ? close : close + 1), id);
    rest.remove_prefix(close == std::string_view::npos ? rest.size() : close + 1);
  }
  return body;
}

/// gnuplot opens a group for every change of pen, whether or not it draws with it.
std::string without_empty_groups(std::string_view body) {
  static constexpr std::string_view kClosed = ">\n</g>\n";
  static constexpr std::string_view kOpened = "<g fill=\"none\"";
  std::string kept;
  while (!body.empty()) {
    const std::size_t open = body.find(kOpened);
    kept += body.substr(0, open);
    if (open == std::string_view::npos) break;
    body.remove_prefix(open);
    const std::size_t close = body.find('>');
    if (close != std::string_view::npos && body.substr(close).starts_with(kClosed)) {
      body.remove_prefix(close + kClosed.size());
    } else {
      kept += kOpened;
      body.remove_prefix(kOpened.size());
    }
  }
  return kept;
}

}  // namespace

std::string accessible_svg(std::string_view drawn, const Figure& figure) {
  static constexpr std::string_view kDescribed = "</desc>";
  const std::string_view box = attribute(drawn, "viewBox=\"");
  const std::size_t described = drawn.find(kDescribed);
  if (described == std::string_view::npos) {
    throw Error("gnuplot: printed no SVG; try version 5.2 or later");
  }
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" "
             "xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{0}cm\" height=\"{1}cm\" "
             "viewBox=\"{2}\" role=\"img\" aria-labelledby=\"{3}-title {3}-desc\">\n"
             "<title id=\"{3}-title\">{4}</title>\n<desc id=\"{3}-desc\">{5}</desc>\n",
             figure.width_cm, figure.height_cm, box, figure.id,
             escaped(first_sentence(figure.caption)), escaped(figure.alt)) +
         without_empty_groups(body_of(drawn.substr(described + kDescribed.size()), figure.id));
}

}  // namespace touchtrial::analysis
