#!/usr/bin/env python3
"""How scripts/bench judges, compares and prints what was measured."""

import importlib.machinery
import importlib.util
import pathlib
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts" / "bench"
loader = importlib.machinery.SourceFileLoader("bench", str(SCRIPT))
bench = importlib.util.module_from_spec(importlib.util.spec_from_loader("bench", loader))
loader.exec_module(bench)


def filter_row(ratio, goal=0.5, limits="ratio", **more):
    ours = {"us": 100 * ratio, "error": 1e-6, "error_kind": "grey levels", **more}
    if goal is not None:
        ours.update(goal=goal, goal_kind=limits)
    return bench.row_of("filter", {"touchtrial": ours, "peer": {"us": 100.0}})


def results(*rows):
    return {"processor": "Z80", "compiler": "C", "opencv": "4", "date": "2026-01-01", "rows": list(rows)}


class Goals(unittest.TestCase):
    def test_a_goal_is_met_up_to_its_target(self):
        self.assertTrue(filter_row(0.5)["met"])
        self.assertFalse(filter_row(0.51)["met"])
        self.assertIsNone(filter_row(0.6, None)["met"])

    def test_a_goal_is_judged_by_the_number_that_it_limits(self):
        self.assertFalse(filter_row(2.0, 1e-5, "us")["met"])
        self.assertTrue(filter_row(2.0, 0, "count", count=0, count_kind="pixels")["met"])
        self.assertFalse(filter_row(2.0, 0, "count", count=1, count_kind="pixels")["met"])
        self.assertFalse(filter_row(0.1, 1.6, "of bound")["met"])

    def test_the_larger_bound_counts_and_of_its_ways_the_fastest(self):
        row = bench.row_of("filter", {"touchtrial": {"us": 30.0}, "bound: arithmetic": {"us": 5.0},
                                      "bound: memory": {"us": 12.0}, "bound: memory, past caches": {"us": 10.0}})
        self.assertEqual((row["bound"], row["bound_us"], row["of_bound"]), ("memory", 10.0, 3.0))
        self.assertEqual(row["peers"], [])


class Cases(unittest.TestCase):
    def test_a_case_is_the_median_of_its_repetitions_by_the_clock_that_its_name_ends_with(self):
        runs = [{"run_name": "a | b/repeats:3/process_time", "cpu_time": 9.0, "real_time": 8.0},
                {"run_name": "a | b/repeats:3/process_time", "aggregate_name": "median", "cpu_time": 2.0,
                 "real_time": 3.0, "error: grey levels": 0.5}]
        self.assertEqual(bench.case_of(runs), {"us": 2.0, "error": 0.5, "error_kind": "grey levels"})
        self.assertEqual(bench.case_of([{"run_name": "a | b/repeats:1/real_time", "cpu_time": 1.0, "real_time": 4.0}]),
                         {"us": 4.0})

    def test_cases_stand_as_in_the_table_however_runs_took_turns(self):
        places = {("a", "touchtrial"): 0, ("a", "peer"): 1}
        runs = [{"run_name": f"a | {who}/repeats:1/process_time", "cpu_time": us}
                for who, us in (("peer", 9.0), ("touchtrial", 3.0))]
        self.assertEqual(list(bench.cases_of(runs, places).items()), [("touchtrial", {"us": 3.0}), ("peer", {"us": 9.0})])

    def test_what_is_only_counted_has_no_time(self):
        run = {"run_name": "a | b/iterations:1/repeats:1", "cpu_time": 1.0, "real_time": 4.0, "count: steps": 50.0}
        self.assertEqual(bench.case_of([run]), {"count": 50.0, "count_kind": "steps"})

    def test_a_case_that_computes_something_else_ends_the_measurement(self):
        with self.assertRaises(SystemExit):
            bench.case_of([{"name": "a", "run_name": "a", "error_occurred": True, "error_message": "wrong"}])


class Comparison(unittest.TestCase):
    def test_what_is_slower_by_more_than_a_tenth_is_named(self):
        before = filter_row(0.4)
        self.assertEqual(bench.slower_lines(results(filter_row(0.43)), results(before)), [])
        self.assertEqual(len(bench.slower_lines(results(filter_row(0.45)), results(before))), 1)
        self.assertEqual(bench.slower_lines(results({**filter_row(0.45), "what": "another"}), results(before)), [])
        bounded = {**before, "of_bound": 1.5}
        self.assertEqual(len(bench.slower_lines(results({**before, "of_bound": 1.7}), results(bounded))), 1)


class Tables(unittest.TestCase):
    def test_goals_and_records_stand_apart_and_only_goals_are_judged(self):
        rows = results(filter_row(0.4), {**filter_row(0.6), "what": "slow"}, {**filter_row(0.7, None), "what": "free"})
        goals, record = bench.goals_table(rows), bench.record_table(rows)
        self.assertIn("| <= 0.5 | yes    |", goals)
        self.assertIn("**no**", goals)
        self.assertNotIn("free", goals)
        self.assertIn("| free | 70 us | 1.0e-06 grey levels | peer | 100 us |", record)
        self.assertNotIn("slow", record)

    def test_the_further_peers_of_a_goal_are_for_the_record(self):
        row = bench.row_of("filter", {"touchtrial": {"us": 1.0, "goal": 2, "goal_kind": "ratio"}, "first": {"us": 1.0},
                                      "second": {"us": 1.0}})
        self.assertNotIn("second", bench.goals_table(results(row)))
        self.assertIn("second", bench.record_table(results(row)))
        self.assertNotIn("first", bench.record_table(results(row)))

    def test_a_section_is_replaced_alone_and_again(self):
        page = "# Title\n\n<!-- goals -->\nold\n<!-- end of goals -->\n\nrest\n"
        once = bench.replace_section(page, "goals", "new\n")
        self.assertEqual(once, "# Title\n\n<!-- goals -->\n\nnew\n\n<!-- end of goals -->\n\nrest\n")
        self.assertEqual(bench.replace_section(once, "goals", "new\n"), once)

    def test_a_page_without_the_section_is_refused(self):
        for page in ("# Title\n", "<!-- goals -->\n", "<!-- end of goals -->\n<!-- goals -->\n"):
            with self.assertRaises(SystemExit):
                bench.replace_section(page, "goals", "new\n")


if __name__ == "__main__":
    unittest.main()
