// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/syntax/sexpr.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "pcbmesh/base/error.hpp"

namespace {

using namespace pcbmesh;
using formats::syntax::Sexpr;
using formats::syntax::SexprTree;

struct Failure {
  ErrorCode code = ErrorCode::internal;
  std::int64_t line = 0;
};
Failure failure_of(std::string text) {
  try {
    const SexprTree tree(std::move(text), "f");
  } catch (const Error& error) {
    return {error.code(), error.spot().line};
  }
  return {};
}

TEST(Sexpr, WalksListsWordsAndStrings) {
  const SexprTree tree("(a b \"c d\"\n (e 1 (f)) (g) () h)\n", "f");
  const Sexpr a = tree.root();
  EXPECT_EQ(a.head(), "a");
  EXPECT_TRUE(a.arg(0).is_word());
  EXPECT_TRUE(a.arg(1).is_quoted());
  EXPECT_EQ(a.arg(1).raw(), "c d");
  EXPECT_EQ(a.child("e").arg(0).raw(), "1");
  EXPECT_EQ(a.child("e").arg(1).head(), "f");
  EXPECT_EQ(a.child("e").line(), 2);
  EXPECT_TRUE(a.child("g"));
  EXPECT_FALSE(a.child("g").arg(0));
  EXPECT_TRUE(a.arg(4).is_list());
  EXPECT_EQ(a.arg(4).head(), "");
  EXPECT_TRUE(a.has_word("h"));
  EXPECT_FALSE(a.has_word("e"));
  EXPECT_FALSE(a.arg(6));
  int items = 0;
  for (const Sexpr item : a) items += item ? 1 : 0;
  EXPECT_EQ(items, 7);
}

TEST(Sexpr, AbsentAnswersEverythingWithNothing) {
  const Sexpr none;
  EXPECT_FALSE(none.child("x").arg(3).next().first());
  EXPECT_EQ(none.raw(), "");
  EXPECT_EQ(none.text(), "");
  EXPECT_EQ(none.line(), 0);
  EXPECT_FALSE(none.has_word(""));
}

TEST(Sexpr, ResolvesEscapes) {
  const SexprTree tree(R"((a "q\"(b)\\n\n|" "" plain\x))", "f");
  EXPECT_EQ(tree.root().arg(0).text(), "q\"(b)\\n\n|");
  EXPECT_EQ(tree.root().arg(1).text(), "");
  EXPECT_TRUE(tree.root().arg(1).is_quoted());
  EXPECT_EQ(tree.root().arg(2).text(), "plain\\x");
}

TEST(Sexpr, TakesOddWordsOfOldWriters) {
  const SexprTree tree("\xEF\xBB\xBF(a /b*c ~ {x}#1 &/ -0.000001 1e-05\n # a comment ) line\n b)", "f");
  EXPECT_EQ(tree.root().arg(0).raw(), "/b*c");
  EXPECT_EQ(tree.root().arg(2).raw(), "{x}#1");
  EXPECT_EQ(tree.root().arg(5).raw(), "1e-05");
  EXPECT_EQ(tree.root().arg(6).raw(), "b");
}

TEST(Sexpr, SkipsDataBlocksWithBracketsInside) {
  const SexprTree tree("(files (data |KLUv((\"\n)a==|) (b))", "f");
  EXPECT_EQ(tree.root().child("data").arg(0).raw().size(), 14U);
  EXPECT_TRUE(tree.root().child("b"));
}

TEST(Sexpr, PutsAForgottenBracketBack) {
  constexpr std::array<std::string_view, 1> words{"filter_ratio"};
  const SexprTree tree("(board (teardrops (curved_edges no)filter_ratio 0.9) (x (filter_ratio 1)))\n (b))", "f", {words});
  EXPECT_EQ(tree.root().child("teardrops").child("filter_ratio").arg(0).raw(), "0.9");
  EXPECT_EQ(tree.root().child("teardrops").child("x").child("filter_ratio").arg(0).raw(), "1");
  EXPECT_TRUE(tree.root().child("b"));
  ASSERT_EQ(tree.repaired_lines().size(), 1U);
  EXPECT_EQ(tree.repaired_lines()[0], 1);
}

TEST(Sexpr, NamesTheLineOfWhatIsWrong) {
  EXPECT_EQ(failure_of("").code, ErrorCode::file_truncated);
  EXPECT_EQ(failure_of(" \n ").code, ErrorCode::file_truncated);
  EXPECT_EQ(failure_of("PK\x03\x04").code, ErrorCode::file_syntax);
  const Failure open = failure_of("(a\n (b)\n (c\n (d)");
  EXPECT_EQ(open.code, ErrorCode::file_truncated);
  EXPECT_EQ(open.line, 3);
  const Failure text = failure_of("(a\n \"bc)");
  EXPECT_EQ(text.code, ErrorCode::file_truncated);
  EXPECT_EQ(text.line, 2);
  EXPECT_EQ(failure_of("(a \"b\\").code, ErrorCode::file_truncated);
  EXPECT_EQ(failure_of("(a |bc)").code, ErrorCode::file_truncated);
  const Failure extra = failure_of("(a\n (b))\n) (c)");
  EXPECT_EQ(extra.code, ErrorCode::file_syntax);
  EXPECT_EQ(extra.line, 3);
  EXPECT_EQ(failure_of(")").code, ErrorCode::file_syntax);
}

TEST(Sexpr, AnyDepthOfNestingIsTaken) {
  const std::size_t depth = 1000000;
  const SexprTree tree("(a " + std::string(depth, '(') + std::string(depth, ')') + " (b))", "f");
  EXPECT_TRUE(tree.root().child("b"));
  EXPECT_EQ(failure_of("(a" + std::string(depth, '(')).code, ErrorCode::file_truncated);
}

TEST(Sexpr, EveryPrefixEitherParsesOrSaysWhy) {
  const std::string whole = "(a \"b\\\"c\" |d(e| (f 1 2)\n # g )\n (h))";
  for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_EQ(failure_of(whole.substr(0, n)).code, ErrorCode::file_truncated) << n;
  EXPECT_EQ(failure_of(whole).code, ErrorCode::internal);
}

}  // namespace
