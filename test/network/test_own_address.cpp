#include "flute_grinder/network/own_address.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

namespace grinder {
namespace test_own_address {

const std::string kAllowed =
    "; allowed: 127.0.0.1 or localhost for this computer alone, or the address under which others reach it";

class OwnAddress : public testing::Test {
 protected:
  OwnAddress() { clear(); }
  ~OwnAddress() override { clear(); }

  static void clear() {
    for (const char* variable : {"ROS_HOSTNAME", "ROS_IP", "ROS_IPV6"}) unsetenv(variable);
  }
  static std::string refusalOf(const char* variable, const std::string& name) {
    setenv(variable, name.c_str(), 1);
    const std::string refusal = ownAddressRefusal();
    unsetenv(variable);
    return refusal;
  }
};

TEST_F(OwnAddress, WhatOpensAllPortsIsRefused) {
  EXPECT_EQ(ownAddressRefusal(),
            "neither ROS_HOSTNAME nor ROS_IP is set, and every computer could move the machine" + kAllowed);
  EXPECT_EQ(refusalOf("ROS_HOSTNAME", ""), "ROS_HOSTNAME is empty" + kAllowed);
  for (const std::string name : {"LOCALHOST", "0x7f.1"}) {
    EXPECT_EQ(refusalOf("ROS_HOSTNAME", name),
              "ROS_HOSTNAME = " + name + " is loopback in words that ROS does not know" + kAllowed);
  }
  for (const std::string name : {"0.0.0.0", "0", "0x0"}) {
    for (const std::string variable : {"ROS_HOSTNAME", "ROS_IP"}) {
      EXPECT_EQ(refusalOf(variable.c_str(), name), variable + " = " + name + " is every address" + kAllowed);
    }
  }
  EXPECT_EQ(refusalOf("ROS_HOSTNAME", "no_such.invalid").rfind("ROS_HOSTNAME = no_such.invalid has no address: ", 0),
            0U);
}

TEST_F(OwnAddress, OneOfIpv6NeedsIt) {
  for (const std::string name : {"::1", "::", "fd9e::1"}) {
    EXPECT_EQ(refusalOf("ROS_IP", name),
              "ROS_IP = " + name + " is an address of IPv6; allowed: one of IPv4, or ROS_IPV6=on beside it");
  }
  setenv("ROS_IPV6", "on", 1);
  EXPECT_EQ(refusalOf("ROS_IP", "::1"), "");
  EXPECT_EQ(refusalOf("ROS_IP", "fd9e::1"), "");
  EXPECT_EQ(refusalOf("ROS_IP", "::"), "ROS_IP = :: is every address" + kAllowed);
}

TEST_F(OwnAddress, OthersAreGood) {
  std::array<char, 256> own{};
  ASSERT_EQ(gethostname(own.data(), own.size() - 1), 0);
  for (const std::string& name :
       {std::string("localhost"), std::string("127.0.0.1"), std::string("192.0.2.1"), std::string(own.data())}) {
    EXPECT_EQ(refusalOf("ROS_HOSTNAME", name), "") << name;
  }
}

TEST_F(OwnAddress, TheHostsNameComesFirst) {
  setenv("ROS_IP", "0.0.0.0", 1);
  EXPECT_EQ(refusalOf("ROS_HOSTNAME", "localhost"), "");
}

}  // namespace test_own_address
}  // namespace grinder
