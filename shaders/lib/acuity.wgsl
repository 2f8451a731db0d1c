// Twin of src/kernel/acuity.rs.
