// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_records.h"

#include "support/synthetic_laz.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/las/las.h"
#include "limen/io/las/laz/laz_integer.h"

namespace limen {
namespace {

using testing_las::Parts;
using testing_las::records_of;
using testing_laz::Packing;

Parts some_records(int format, std::size_t count, std::size_t extra = 0) {
  Parts parts;
  parts.minor = 4;
  parts.format = format;
  parts.extra = extra;
  parts.points = testing_las::random_points(format, extra, count, 11);
  return parts;
}

/// What the error says, or "no error".
std::string laz_error_of(const std::string& bytes) {
  try {
    records_of(bytes, 100000);
  } catch (const Error& error) {
    return error.problem();
  }
  return "no error";
}

TEST(LazArithmetic, SymbolsBitsAndIntegersComeBack) {
  RandomStream random(5);
  testing_laz::Encoder encoder;
  laz::SymbolModel<516> many;
  laz::SymbolModel<13> few;
  laz::BitModel bit;
  testing_laz::IntegerEncoder<32, 2> wide;
  testing_laz::IntegerEncoder<16, 1> narrow;
  std::vector<std::int32_t> wanted;
  for (int i = 0; i < 20000; ++i) {
    wanted.push_back(static_cast<std::int32_t>(random.below(1 + random.below(516))));
    encoder.symbol(many, static_cast<unsigned>(wanted.back()));
    wanted.push_back(static_cast<std::int32_t>(random.below(1 + random.below(13))));
    encoder.symbol(few, static_cast<unsigned>(wanted.back()));
    wanted.push_back(random.below(9) == 0 ? 1 : 0);
    encoder.bit(bit, wanted.back() == 1);
    wanted.push_back(static_cast<std::int32_t>(random.next() >> random.below(32)));
    wide.encode(encoder, wanted.back(), i % 7 == 0 ? INT32_MIN : 5, random.below(1));
    wanted.push_back(static_cast<std::int32_t>(random.below(65536)));
    narrow.encode(encoder, wanted.back(), 60000);
    wanted.push_back(static_cast<std::int32_t>(random.next()));
    encoder.bits(32, static_cast<std::uint32_t>(wanted.back()));
  }
  const std::string bytes = encoder.finish();
  laz::Decoder decoder(bytes);
  laz::SymbolModel<516> many_again;
  laz::SymbolModel<13> few_again;
  laz::BitModel bit_again;
  laz::IntegerDecoder<32, 2> wide_again;
  laz::IntegerDecoder<16, 1> narrow_again;
  many_again.reset();
  few_again.reset();
  for (std::size_t i = 0; i < wanted.size(); i += 6) {
    ASSERT_EQ(static_cast<std::int32_t>(decoder.symbol(many_again)), wanted[i]);
    ASSERT_EQ(static_cast<std::int32_t>(decoder.symbol(few_again)), wanted[i + 1]);
    ASSERT_EQ(decoder.bit(bit_again) ? 1 : 0, wanted[i + 2]);
    ASSERT_EQ(wide_again.decode(decoder, (i / 6) % 7 == 0 ? INT32_MIN : 5), wanted[i + 3]);
    ASSERT_EQ(narrow_again.decode(decoder, 60000), wanted[i + 4]);
    ASSERT_EQ(static_cast<std::int32_t>(decoder.bits(32)), wanted[i + 5]);
  }
  EXPECT_TRUE(decoder.sound(true));
}

TEST(LazRecords, EveryFormatComesBack) {
  for (int format = 0; format <= 10; ++format) {
    for (const std::size_t extra : {std::size_t{0}, std::size_t{5}}) {
      const Parts parts = some_records(format, 2500, extra);
      for (const int version : {3, 4}) {
        Packing packing;
        packing.chunk = 1100;
        packing.version = version;
        const std::string bytes = testing_laz::file(parts, packing);
        EXPECT_TRUE(records_of(bytes, 100000) == parts.points) << format << " " << version;
        EXPECT_TRUE(records_of(bytes, 700) == parts.points) << format << ", chunks larger than pieces";
      }
    }
  }
}

TEST(LazRecords, EveryPackingComesBack) {
  for (const int format : {1, 7}) {
    const Parts parts = some_records(format, 3001);
    Packing variable;
    variable.variable = true;
    Packing at_end;
    at_end.table_at_end = true;
    Packing single;
    single.chunk = 1;
    for (const Packing& packing : {variable, at_end, single})
      EXPECT_TRUE(records_of(testing_laz::file(parts, packing)) == parts.points) << format;
  }
  Packing one_run;
  one_run.one_run = true;
  const Parts parts = some_records(3, 3001);
  EXPECT_TRUE(records_of(testing_laz::file(parts, one_run), 100) == parts.points);
}

TEST(LazRecords, ValuesThatNeverChangeHaveNoLayers) {
  Parts parts = some_records(8, 1, 2);
  const std::string one = parts.points;
  for (int i = 0; i < 500; ++i) parts.points += one;
  EXPECT_TRUE(records_of(testing_laz::file(parts)) == parts.points);
}

TEST(LazRecords, NoPointsAreNoError) {
  const std::string bytes = testing_laz::file(some_records(6, 0));
  EXPECT_EQ(laz_error_of(bytes), "no error");
  EXPECT_EQ(open_las(bytes, "test")->read(0)->next(10), std::nullopt);
}

TEST(LazRecords, TheSameForAnyThreads) {
  const std::string bytes = testing_laz::file(some_records(7, 20000));
  set_thread_count(1);
  const std::string one = records_of(bytes, 6000);
  set_thread_count(0);
  EXPECT_TRUE(one == records_of(bytes, 3000));
}

TEST(LazRecords, DamageIsStated) {
  const std::string whole = testing_laz::file(some_records(3, 1000));
  EXPECT_EQ(laz_error_of(whole.substr(0, whole.size() - 300)).substr(0, 33),
            "the table of its compressed chunk");
  std::string fewer = whole;
  testing_las::put(fewer, 107, std::uint32_t{999});
  testing_las::put(fewer, 247, std::uint64_t{999});
  EXPECT_NE(laz_error_of(fewer), "no error");
  std::string more = whole;
  testing_las::put(more, 247, std::uint64_t{1001});
  EXPECT_EQ(laz_error_of(more), "the header promises 1001 points, the compressed chunks hold 1000");
  std::string far = whole;
  testing_las::put(far, 247, std::uint64_t{1} << 62U);
  EXPECT_NE(laz_error_of(far), "no error");
}

TEST(LazRecords, ACountThatNoBytesCanHold) {
  Packing one_run;
  one_run.one_run = true;
  std::string bytes = testing_laz::file(some_records(1, 100), one_run);
  testing_las::put(bytes, 247, std::uint64_t{1} << 40U);
  EXPECT_EQ(laz_error_of(bytes).substr(0, 30), "1099511627776 points cannot be");
}

TEST(LazRecords, AnyShortenedOrChangedFileIsReadOrRefused) {
  RandomStream random(9);
  for (const int format : {0, 5, 6, 10}) {
    Packing packing;
    packing.chunk = 40;
    packing.variable = format == 6;
    const std::string whole = testing_laz::file(some_records(format, 120, 2), packing);
    for (std::size_t length = 0; length < whole.size(); length += 13)
      EXPECT_NE(laz_error_of(whole.substr(0, length)), "no error") << length;
    int refused = 0;
    for (int trial = 0; trial < 400; ++trial) {
      std::string bytes = whole;
      for (std::uint32_t k = random.below(4) + 1; k > 0; --k)
        bytes[random.below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<char>(random.below(256));
      refused += laz_error_of(bytes) == "no error" ? 0 : 1;
    }
    EXPECT_GT(refused, 100);
  }
}

TEST(TransformLaz, BecomesLasWithAllRecords) {
  Parts parts = some_records(7, 700, 1);
  parts.records.push_back(testing_las::record("LASF_Projection", 2112, "WKT"));
  parts.tail =
      testing_las::long_record("copc", 1000, "chunks") + testing_las::long_record("someone", 78, "behind");
  parts.tail_records = 2;
  const testing_io::TemporaryFolder folder;
  Rigid3 motion;
  motion.rotation = rotation_exp({0.0, 0.0, 0.5});
  const std::string before = testing_laz::file(parts);
  const TransformedCloud result = transform_las(before, "test", motion, folder / "out.las");
  EXPECT_EQ(result.points, 700U);
  const std::string after = testing_io::slurp(folder / "out.las");
  const LasHeader header = parse_las_header(after, "test");
  EXPECT_FALSE(header.compressed);
  EXPECT_TRUE(header.notes.empty());
  EXPECT_EQ(header.find("laszip encoded", 22204), nullptr);
  EXPECT_EQ(header.find("copc", 1000), nullptr);
  ASSERT_NE(header.find("LASF_Projection", 2112), nullptr);
  ASSERT_NE(header.find("someone", 78), nullptr);
  EXPECT_EQ(header.find("someone", 78)->body, "behind");
  std::string moved = records_of(after);
  for (std::size_t at = 0; at < moved.size(); at += header.point_bytes)
    moved.replace(at, 12, parts.points, at, 12);
  EXPECT_TRUE(moved == parts.points);
  EXPECT_NEAR(testing_las::column(after, "x").at(3),
              std::cos(0.5) * testing_las::column(before, "x").at(3) -
                  std::sin(0.5) * testing_las::column(before, "y").at(3),
              1e-4);
}

}  // namespace
}  // namespace limen
