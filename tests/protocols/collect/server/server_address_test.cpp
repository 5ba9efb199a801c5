#include "protocols/collect/server_address.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"

#include <string>

using namespace touchtrial;
using namespace touchtrial::collect;

namespace {

std::string refusal_of(const std::string& where) {
  try {
    const ServerAddress address(where);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("everything with a scheme is an address and no file") {
  CHECK(is_address("postgresql://host/study"));
  CHECK(is_address("postgressql://host/study"));
  CHECK_FALSE(is_address("study.db"));
  CHECK_FALSE(is_address("/data/postgresql/study.db"));
}

TEST_CASE("an address is shown without its user") {
  CHECK(ServerAddress("postgresql://anna@lab.example:5433/study").shown() ==
        "postgresql://lab.example:5433/study");
  CHECK(ServerAddress("postgresql:///study?host=/run/x&user=anna").shown() ==
        "postgresql:///study?host=/run/x");
  CHECK(ServerAddress("postgresql://?service=lab").shown() == "postgresql:///?service=lab");
}

TEST_CASE("an address is passed on whole, and waits a bounded time") {
  const std::string text =
      ServerAddress("postgresql://anna@lab.example/st%27u%5Cdy?options=-csearch_path%3Dpilot")
          .connection_string();
  CHECK_THAT(text, holds_text("user='anna'"));
  CHECK_THAT(text, holds_text("host='lab.example'"));
  CHECK_THAT(text, holds_text("dbname='st\\'u\\\\dy'"));
  CHECK_THAT(text, holds_text("options='-csearch_path=pilot'"));
  CHECK_THAT(text, holds_text("connect_timeout='10'"));
  CHECK_THAT(ServerAddress("postgresql://lab/study?connect_timeout=3").connection_string(),
             holds_text("connect_timeout='3'"));
}

TEST_CASE("an address with a password is refused, and not repeated") {
  for (const char* const where :
       {"postgresql://anna:geheim@lab/study", "postgresql://lab/study?password=geheim",
        "postgresql://lab/study?sslpassword=geheim", "postgres://anna:geheim@lab/study"}) {
    const std::string line = refusal_of(where);
    INFO(where);
    CHECK_THAT(line, holds_text(".pgpass"));
    CHECK(line.find("geheim") == std::string::npos);
  }
}

TEST_CASE("a text that is no address is refused, and not repeated") {
  for (const char* const where : {"postgressql://anna:geheim@lab/study", "mysql://geheim@lab",
                                  "host=lab password=geheim", "postgresql://anna:geheim@[lab/study",
                                  "postgresql://lab/study?passwort=geheim", "study.db", ""}) {
    const std::string line = refusal_of(where);
    INFO(where);
    CHECK_THAT(line, holds_text("postgresql://USER@HOST/DATABASE"));
    CHECK(line.find("geheim") == std::string::npos);
  }
}
