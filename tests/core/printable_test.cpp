#include "core/printable.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"

using namespace touchtrial;

TEST_CASE("no control of a terminal or of the direction of text is left in a message") {
  CHECK(one_line("a\x1b[31mb") == "a [31mb");
  CHECK(one_line("a\xc2\x9b"
                 "b") == "a\\u009bb");
  CHECK(one_line("P\xe2\x80\xae"
                 "70") == "P\\u202e70");
  for (const char* control :
       {"\xe2\x80\xaa", "\xe2\x80\xae", "\xe2\x81\xa6", "\xe2\x81\xa9", "\xe2\x80\x8e",
        "\xe2\x80\x8f", "\xd8\x9c", "\xe2\x80\xa8", "\xc2\x85"}) {
    CHECK(one_line(control).starts_with("\\u"));
    CHECK(printable(control).starts_with("\\u"));
  }
  const std::string harmless = "\xc3\xa9 \xd7\xa9 \xe2\x80\x93 \xe2\x81\xa0 \xf0\x9f\x98\x80";
  CHECK(one_line(harmless) == harmless);
  CHECK(printable(harmless) == harmless);
}

TEST_CASE("printable keeps lines and tabs, and shows all other controls") {
  CHECK(printable("a\n\tb\n") == "a\n\tb\n");
  CHECK(printable("\x1b]0;title\x07") == "\\u001b]0;title\\u0007");
  CHECK(printable("over\rwritten\x7f") == "over\\u000dwritten\\u007f");
  CHECK(printable("\x9b") == "\\x9b");
}
