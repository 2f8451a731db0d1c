// Twin of src/kernel/approx.rs.
