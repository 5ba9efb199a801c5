// Links if forwarders.cpp has every function of libpq that libpqxx calls for protocols/collect.
#include "protocols/collect/libpqxx_calls.hpp"

int main() {
  using namespace touchtrial::collect;
  pqxx::connection connection("dbname=probe");
  const QuietNotices quiet(connection);
  pqxx::nontransaction plain(connection);
  pqxx::work work(connection);
  const std::string sql = "SELECT $1";
  const pqxx::result rows = executed(work, sql, 1, binary({}));
  work.commit();
  return executed_with_lists(plain, sql, {}, {}).at(0)[0].as<int>() +
         static_cast<int>(bytes_of(rows[0][0]).size()) + connection.server_version() +
         connection.sock();
}
