// Arrays in files: what is written is read again, by this program and by others.
#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

#include "app/base/npz.h"
#include "program.h"
#include "scenes/read/input_error.h"

namespace tests {
namespace {

using app::NpzFile;

class Npz : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    path = folder / "a.npz";
    NpzFile file = NpzFile::create(path);
    const int table = file.add({"table", "<f8", {5, 2}});
    const int growing = file.add({"growing", "<u8", {NpzFile::kGrows}});
    for (int row = 0; row < 3; ++row) {  // of five that there was room for
      const double numbers[] = {row + 0.5, -row / 3.0};
      file.append(table, numbers, 1);
      const std::uint64_t more[] = {1, 2, 3};
      file.append(growing, more, static_cast<std::uint64_t>(row));
    }
    const int text = file.add({"text", "|S4", {2}});
    file.append(text, "ab\0\0defg", 2);
    double early[2];
    file.read(table, 1, 1, early);
    EXPECT_EQ(early[0], 1.5);  // before it is whole
    file.commit();
  }

  std::filesystem::path path;
};

TEST_F(Npz, WhatIsWrittenIsReadAgain) {
  const NpzFile file = NpzFile::open(path);
  const int table = file.find("table");
  ASSERT_GE(table, 0);
  EXPECT_EQ(file.array(table).type, "<f8");
  EXPECT_EQ(file.array(table).shape, (std::vector<std::uint64_t>{3, 2}));
  double last[2];
  file.read(table, 2, 1, last);
  EXPECT_EQ(last[0], 2.5);
  EXPECT_EQ(last[1], -2 / 3.0);
  EXPECT_EQ(file.rows(file.find("growing")), 3u);
  EXPECT_EQ(file.find("none"), -1);
}

TEST_F(Npz, OtherProgramsFindTheArchiveWhole) {
  if (std::system("python3 -c '' 2>/dev/null") != 0) GTEST_SKIP() << "no Python here";
  writeText(folder / "read.py", R"(import struct, sys, zipfile
archive = zipfile.ZipFile(sys.argv[1])
assert archive.testzip() is None
assert archive.namelist() == ['table.npy', 'growing.npy', 'text.npy']
table = archive.read('table.npy')
assert table[:8] == b'\x93NUMPY\x01\x00' and table[127:128] == b'\n', table[:128]
head = eval(table[10:128])
assert head == {'descr': '<f8', 'fortran_order': False, 'shape': (3, 2)}, head
assert struct.unpack('<6d', table[128:])[4] == 2.5
assert archive.read('text.npy')[128:] == b'ab\0\0defg'
)");
  const std::string command =
      "python3 '" + (folder / "read.py").string() + "' '" + path.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

std::string allNumbers(const NpzFile& file) {
  std::string bytes;
  for (const char* name : {"table", "growing", "text"}) {
    const int array = file.find(name);
    if (array < 0) return "";
    std::string rows(file.rows(array) * file.array(array).rowBytes(), 0);
    file.read(array, 0, file.rows(array), rows.data());
    bytes += rows;
  }
  return bytes;
}

// Heads of the archive have no checksum: what is damaged there is refused, or does not matter.
TEST_F(Npz, WhatIsDamagedIsRefusedOrDoesNotMatter) {
  const std::string whole = readBytes(path), numbers = allNumbers(NpzFile::open(path));
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{30}, whole.size() / 2, whole.size() - 1}) {
    writeText(path, whole.substr(0, size));
    EXPECT_THROW(NpzFile::open(path), scenes::InputError) << size;
  }
  int refused = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x40);
    writeText(path, damaged);
    try {
      const std::string read = allNumbers(NpzFile::open(path));
      EXPECT_TRUE(read.empty() || read == numbers) << at;
    } catch (const scenes::InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, static_cast<int>(whole.size()) / 2);
}

TEST_F(Npz, WithoutCommitNothingIsLeft) {
  { NpzFile::create(folder / "b.npz").add({"x", "<f8", {1}}); }
  EXPECT_FALSE(std::filesystem::exists(folder / "b.npz"));
  EXPECT_FALSE(std::filesystem::exists(folder / "b.npz.part"));
}

}  // namespace
}  // namespace tests
