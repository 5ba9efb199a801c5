#include "bench/docs/page_section.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"

namespace touchtrial::bench {
namespace {

const std::string kPage = "# Title\n\n<!-- goals -->\nold\n<!-- end of goals -->\n\nrest\n";

TEST_CASE("with_section replaces what lies between the two lines and nothing else") {
  CHECK(with_section(kPage, "goals", "new\n") ==
        "# Title\n\n<!-- goals -->\n\nnew\n\n<!-- end of goals -->\n\nrest\n");
}

TEST_CASE("with_section gives the same when it is done again") {
  const std::string once = with_section(kPage, "goals", "new\n");
  CHECK(with_section(once, "goals", "new\n") == once);
}

TEST_CASE("with_section refuses a page without the section, and says which lines are missing") {
  CHECK_THROWS_AS(with_section("# Title\n", "goals", "new\n"), Error);
  CHECK_THROWS_WITH(with_section("<!-- goals -->\n", "goals", ""),
                    holds_text("<!-- end of goals -->"));
  CHECK_THROWS_AS(with_section("<!-- end of goals -->\n<!-- goals -->\n", "goals", ""), Error);
}

}  // namespace
}  // namespace touchtrial::bench
