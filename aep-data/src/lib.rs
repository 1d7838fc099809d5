//! Recordings from files: CSV and MATLAB v5, with column mapping, units and errors that say how to mend them.
