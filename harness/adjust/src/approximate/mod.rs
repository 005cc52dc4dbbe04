//! Start values without truth: closed forms and robust searches.
