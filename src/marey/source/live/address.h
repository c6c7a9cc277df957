#pragma once

#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace marey::source::live {

/// A live source as it is named: SCHEME:PLACE?OPTION=VALUE&OPTION, or SCHEME://PLACE?…
struct Address {
  std::string text;  ///< as it was given
  std::string scheme;
  std::string location;
  std::map<std::string, std::string> options;  ///< one without a value is "yes"
};

/// Throws Error if `text` begins with no known scheme, or gives an option twice.
Address parse_address(const std::string& text);

/// Reads the options of an address. Each function leaves `value` as it is where the option is not given, and throws Error for what
/// it cannot be, with what it can.
class AddressOptions {
 public:
  explicit AddressOptions(const Address& address) : address_(address) {}

  void whole(const char* name, int& value, int minimum, int maximum);
  void number(const char* name, double& value, double minimum, double maximum);
  void flag(const char* name, bool& value);
  void text(const char* name, std::string& value);
  /// Width x height, as in "640x480".
  void size(const char* name, int& width, int& height);
  /// "yes" and "no" beside numbers with commas between, as many as wanted.
  void numbers(const char* name, std::vector<double>& values, std::size_t count);

  /// Throws Error for an unknown option.
  void done() const;

 private:
  const std::string* find(const char* name);
  [[noreturn]] void refuse(const char* name, const std::string& required) const;

  const Address& address_;
  std::set<std::string> known_;
};

}  // namespace marey::source::live
