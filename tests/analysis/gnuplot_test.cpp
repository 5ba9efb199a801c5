#include "analysis/figures/gnuplot.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <string>

using namespace touchtrial;
using namespace touchtrial::analysis;

TEST_CASE("gnuplot draws what a script prints") {
  const TempFolder folder;
  const auto picture = folder.path() / "it's a picture.txt";
  draw_with_gnuplot("set terminal dumb 40 10\nplot x\n", picture);
  CHECK(text_of(read_file(picture)).find('*') != std::string::npos);
}

TEST_CASE("a script that gnuplot refuses leaves no picture and one line") {
  const TempFolder folder;
  const auto picture = folder.path() / "picture.txt";
  std::string message;
  try {
    draw_with_gnuplot("set terminal dumb\nplot nonsense(\n", picture);
  } catch (const Error& error) {
    message = error.what();
  }
  CHECK_THAT(message, holds_text("gnuplot: failed ("));
  CHECK(message.find('\n') == std::string::npos);
  CHECK_FALSE(std::filesystem::exists(picture));
  CHECK_THROWS_AS(draw_with_gnuplot("", picture), Error);
}

TEST_CASE("a text becomes one gnuplot string whatever is in it") {
  CHECK(gnuplot_string("it's") == "'it''s'");
  CHECK(gnuplot_string("two\nlines") == "'two lines'");
  CHECK(gnuplot_string("") == "''");
}
