#include "analysis/report/figures/style.hpp"
#include "analysis/report/page/page_style.hpp"
#include "support/catch.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

using analysis::Rgb;

constexpr double kReadable = 4.5;  // WCAG 2.1, success criterion 1.4.3

/// "#5c3b00" or "#fff"
Rgb colour_of(const std::string& text) {
  const auto channel = [&](std::size_t i) {
    const std::string digits =
        text.size() == 4 ? std::string(2, text[1 + i]) : text.substr(1 + 2 * i, 2);
    return std::stoi(digits, nullptr, 16);
  };
  return {channel(0), channel(1), channel(2)};
}

/// The colours of each scheme of the page, by name; later schemes change some of the first's.
std::vector<std::map<std::string, Rgb>> schemes() {
  const std::string style(analysis::page_style());
  std::vector<std::map<std::string, Rgb>> all;
  for (std::size_t at = style.find(":root {"); at != std::string::npos;
       at = style.find(":root {", at + 1)) {
    all.push_back(all.empty() ? std::map<std::string, Rgb>() : all.front());
    const std::size_t end = style.find('}', at);
    for (std::size_t name = style.find("--", at); name < end; name = style.find("--", name + 2)) {
      const std::size_t colon = style.find(':', name);
      const std::size_t hash = style.find('#', colon);
      const std::size_t after = style.find(';', hash);
      all.back()[style.substr(name + 2, colon - name - 2)] =
          colour_of(style.substr(hash, after - hash));
    }
  }
  return all;
}

}  // namespace

TEST_CASE("contrast is computed as WCAG 2.1 says") {
  const Rgb black{0, 0, 0};
  const Rgb white{255, 255, 255};
  CHECK(analysis::contrast(black, white) == Approx(21.0));
  CHECK(analysis::contrast(white, white) == Approx(1.0));
  CHECK(analysis::contrast({119, 119, 119}, white) == Approx(4.48).margin(0.005));
  CHECK(analysis::hex_code({0, 62, 110}) == "#003e6e");
}

TEST_CASE("every cell of a confusion matrix is readable, whatever its share") {
  double darker = 22.0;
  for (int i = 0; i <= 10'000; ++i) {
    const Rgb shade = analysis::shade_of(i / 10'000.0);
    INFO(i);
    REQUIRE(analysis::contrast(analysis::ink_on(shade), shade) >= kReadable);
    const double of_white = analysis::contrast({0, 0, 0}, shade);
    REQUIRE(of_white <= darker);  // a larger share is never lighter
    darker = of_white;
  }
  CHECK(analysis::shade_of(0.0) == Rgb{255, 255, 255});
  CHECK(analysis::shade_of(1.0) == Rgb{0, 62, 110});
}

TEST_CASE("every text of the page is readable on its ground, in light, dark and print") {
  const auto all = schemes();
  REQUIRE(all.size() == 3);
  const std::vector<std::pair<const char*, const char*>> texts = {{"ink", "ground"},
                                                                  {"ink", "panel"},
                                                                  {"ink", "strong"},
                                                                  {"soft", "ground"},
                                                                  {"soft", "panel"},
                                                                  {"link", "ground"},
                                                                  {"link", "panel"},
                                                                  {"warn-ink", "warn-ground"},
                                                                  {"stamp-ink", "stamp-ground"}};
  for (const auto& scheme : all) {
    for (const auto& [text, ground] : texts) {
      INFO(text << " on " << ground);
      CHECK(analysis::contrast(scheme.at(text), scheme.at(ground)) >= kReadable);
    }
  }
}

}  // namespace touchtrial
