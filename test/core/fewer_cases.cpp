#include <cstdlib>
#include <string>

// For a program that looks at every setpoint under the sanitizers, and takes ten times as long: there it shows what it
// accesses, and the program without them what it computes. RC_PARAMS overrides the number.
static const int fewer_cases = [] {
  const char* params = std::getenv("RC_PARAMS");
  return setenv("RC_PARAMS", ("max_success=30 " + std::string(params ? params : "")).c_str(), 1);
}();
