#include "flute_grinder/network/user_at_host.h"

#include <pwd.h>
#include <unistd.h>

#include <array>

namespace grinder {

std::string userAtHost() {
  const passwd* user = getpwuid(geteuid());
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return std::string(user ? user->pw_name : std::to_string(geteuid())) + "@" + host.data();
}

}  // namespace grinder
