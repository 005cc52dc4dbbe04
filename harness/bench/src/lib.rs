//! Scenarios, runs, records, gates, reports and the command line.
