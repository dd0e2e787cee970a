#include <charconv>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "campaign.h"

/// Writes one campaign of pulls with something hidden in it, or nothing. Knows no law of the program it
/// tests.
namespace {

constexpr const char* usage =
    "blindgen --seed N --case K --kind single|null|null_exact|pair|outside|rig\n"
    "         --design oat22|crossed22|oat48|crossed48 [--effects ID[,ID]] [--cv 5] [--day 2] [--amplitude "
    "1]\n"
    "         [--data FILE.csv] [--truth FILE.json]\n"
    "--cv and --day are deviations in percent. FILE.yaml appears beside FILE.csv; - writes to standard "
    "output.\n";

struct Options {
  blindgen::Spec spec;
  std::string data, truth;
};

template <class Number>
Number number(const std::string& option, const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < Number{0}) {
    throw std::invalid_argument(option + " wants a number >= 0, not \"" + text + "\"");
  }
  return value;
}

template <class Value>
Value named(const std::string& option, const std::optional<Value>& value, const std::string& text) {
  if (!value) throw std::invalid_argument(option + " knows no \"" + text + "\"");
  return *value;
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> items{""};
  for (const char c : list) {
    if (c == ',')
      items.emplace_back();
    else
      items.back() += c;
  }
  return items;
}

void set(Options& options, const std::string& option, const std::string& text) {
  blindgen::Spec& spec = options.spec;
  if (option == "--seed")
    spec.seed = number<std::uint64_t>(option, text);
  else if (option == "--case")
    spec.case_number = number<int>(option, text);
  else if (option == "--kind")
    spec.kind = named(option, blindgen::kind_named(text), text);
  else if (option == "--design")
    spec.design = named(option, blindgen::design_named(text), text);
  else if (option == "--effects")
    spec.effects = text == "drawn" ? std::vector<std::string>{} : split(text);
  else if (option == "--cv")
    spec.sample_scatter = number<double>(option, text) / 100.0;
  else if (option == "--day")
    spec.day_scatter = number<double>(option, text) / 100.0;
  else if (option == "--amplitude")
    spec.amplitude = number<double>(option, text);
  else if (option == "--data")
    options.data = text;
  else if (option == "--truth")
    options.truth = text;
  else
    throw std::invalid_argument("unknown option " + option);
}

Options parse(const std::vector<std::string>& arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); i += 2) {
    if (i + 1 == arguments.size()) throw std::invalid_argument(arguments[i] + " wants a value");
    set(options, arguments[i], arguments[i + 1]);
  }
  if (options.data.empty() && options.truth.empty())
    throw std::invalid_argument("neither --data nor --truth given");
  return options;
}

void write(const std::filesystem::path& path, const std::string& content) {
  if (path == "-") {
    std::cout << content;
    return;
  }
  std::ofstream file(path, std::ios::binary);
  file << content;
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace

int main(int count, char** values) {
  Options options;
  try {
    options = parse({values + 1, values + count});
    const blindgen::Case drawn = blindgen::draw_case(options.spec);
    const blindgen::Campaign campaign = blindgen::measure(options.spec, drawn);
    if (!options.data.empty()) write(options.data, blindgen::data_text(campaign));
    if (!options.data.empty() && options.data != "-") {
      write(std::filesystem::path(options.data).replace_extension(".yaml"), blindgen::sidecar_text());
    }
    if (!options.truth.empty()) write(options.truth, blindgen::truth_text(options.spec, drawn, campaign));
  } catch (const std::invalid_argument& error) {
    std::cerr << "blindgen: " << error.what() << "\n" << usage;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "blindgen: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
