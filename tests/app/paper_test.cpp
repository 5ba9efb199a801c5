#include "app/study_folder.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

using namespace touchtrial;
using namespace touchtrial::engine;

namespace {

/// Writes a blotchy picture.
void write_noise(const fs::path& path, int side) {
  RandomStream random(4, "paper test");
  GreyImage image(side, side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      image.at(y, x) =
          static_cast<std::uint8_t>(40 + 60 * ((x / 7 + y / 5) % 3) + random.below(40));
    }
  }
  make_folder(path.parent_path());
  write_png(path, image);
}

/// The number at a place of a text, and moves the place behind it.
struct PrintedNumber {
  double value = 0.0;
  int decimals = 0;
};
PrintedNumber number_at(const std::string& text, std::size_t& at) {
  const std::size_t begin = at;
  std::size_t point = std::string::npos;
  while (at < text.size() &&
         (std::isdigit(static_cast<unsigned char>(text[at])) != 0 ||
          (text[at] == '.' && point == std::string::npos && at + 1 < text.size() &&
           std::isdigit(static_cast<unsigned char>(text[at + 1])) != 0))) {
    if (text[at] == '.') point = at;
    ++at;
  }
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(at - point) - 1;
  return {std::strtod(text.substr(begin, at - begin).c_str(), nullptr), decimals};
}

/// Where two texts differ by more than a unit in the last digit of a number with decimals; the
/// length of the longer if nowhere.
std::size_t first_difference(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    const bool digits = std::isdigit(static_cast<unsigned char>(a[i])) != 0 &&
                        std::isdigit(static_cast<unsigned char>(b[j])) != 0;
    if (!digits) {
      if (a[i++] != b[j++]) return i - 1;
      continue;
    }
    const std::size_t begin = i;
    const PrintedNumber one = number_at(a, i);
    const PrintedNumber other = number_at(b, j);
    const double unit = one.decimals == 0 ? 0.0 : 1.01 * std::pow(10.0, -one.decimals);
    if (one.decimals != other.decimals || std::abs(one.value - other.value) > unit) return begin;
  }
  return i == a.size() && j == b.size() ? std::max(a.size(), b.size()) : i;
}

bool is_same(const std::string& a, const std::string& b) {
  return first_difference(a, b) == std::max(a.size(), b.size());
}

/// An SVG file without the pixels in it. Of what gnuplot draws, whose lines depend on its version,
/// only the title and the description.
std::string words_in_svg(const fs::path& path) {
  std::string svg = content(path);
  svg.erase(std::min(svg.find("</desc>"), svg.size()));
  constexpr std::string_view kPixels = "base64,";
  for (std::size_t at = 0; (at = svg.find(kPixels, at)) != std::string::npos;) {
    at += kPixels.size();
    svg.erase(at, svg.find('"', at) - at);
  }
  return svg;
}

}  // namespace

TEST_CASE("docs/paper.md equals the output of paper for the built-in pictures") {
  const ProgramFolder folder;
  folder.done("paper --out @paper");
  const fs::path docs = fs::path(TOUCHTRIAL_SOURCE_DIR) / "docs";
  const std::string printed = content(folder.in("paper/paper.md"));
  const std::string kept = content(docs / "paper.md");
  const std::size_t same = first_difference(printed, kept);
  INFO("printed: " << printed.substr(same, 200)
                   << "\nin docs: " << kept.substr(std::min(same, kept.size()), 200)
                   << "\nrun touchtrial paper --out DIR and copy paper.md and images into docs");
  CHECK(is_same(printed, kept));
  for (const fs::directory_entry& one : fs::directory_iterator(folder.in("paper/images"))) {
    INFO(one.path());
    CHECK(is_same(words_in_svg(one.path()), words_in_svg(docs / "images" / one.path().filename())));
    CHECK_THAT(kept, holds_text("(images/" + one.path().filename().string() + ")"));
  }
}

TEST_CASE("paper measures given pictures, twice into one folder with the same result") {
  const ProgramFolder folder;
  write_noise(folder.path() / "a" / "wall.png", 170);
  write_noise(folder.path() / "b" / "wall.png", 161);
  const std::string paper = "paper @a/wall.png @b/wall.png --out @out";
  folder.done(paper);
  const std::string page = content(folder.in("out/paper.html"));
  const json numbers = json::parse(content(folder.in("out/paper.json")));
  REQUIRE(numbers["pictures"].size() == 2);
  CHECK(numbers["pictures"][0]["picture"] == folder.in("a/wall.png"));
  CHECK(numbers["pictures"][1]["picture"] == folder.in("b/wall.png"));
  CHECK(numbers["pictures"][1]["orders"].size() == 19);
  CHECK(numbers["compared"].size() == 2);
  CHECK_THAT(page, holds_text("data:image/png;base64,"));
  folder.done(paper);
  CHECK(content(folder.in("out/paper.html")) == page);
}

TEST_CASE("paper without gnuplot warns and describes the figure that it cannot draw") {
  const ProgramFolder folder;
  write_noise(folder.path() / "wall.png", 161);
  const EnvironmentVariable no_programs("PATH", folder.path().c_str());
  const ProgramResult result = folder.done("paper @wall.png --out @out");
  CHECK(line_count(result.errors) == 1);
  CHECK_THAT(result.errors, holds_text("gnuplot"));
  CHECK_THAT(content(folder.in("out/paper.md")), holds_text("MS-SSIM"));
}

TEST_CASE("paper refuses bad pictures and folders in one line, and writes nothing") {
  const ProgramFolder folder;
  write_noise(folder.path() / "good.png", 161);
  write_png(folder.path() / "pixel.png", GreyImage(1, 1, 9));
  replace_file(folder.path() / "text.png", "no picture");
  check_refused(folder.type("paper @good.png @none.png --out @out"), 1, {"none.png"});
  check_refused(folder.type("paper @text.png --out @out"), 1, {"text.png"});
  check_refused(folder.type("paper @pixel.png --out @out"), 1, {"pixel.png 1 1"});
  check_refused(folder.type("paper @good.png"), 2, {"--out"});
  CHECK_FALSE(fs::exists(folder.in("out")));
  check_refused(folder.type("paper @good.png --out @text.png"), 1, {"text.png"});
}
