"""The same problems in other people's programs, written as a competent user of each would."""
